// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "hirosco/pus/st130_descriptor/descriptor_service.hpp"
#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "hirosco/utilities/crc32.hpp"

/// Another text of the descriptor in the same process (docs/adr/0095).
namespace hirosco {
namespace {

using pus::DescriptorService;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;
using ::testing::StartsWith;

[[nodiscard]] std::string edited(const std::string& from, const std::string& to, std::string text = probe_descriptor) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const std::string wider = edited(R"(name="KP" id="2" type="DOUBLE" init="3" minimum="0" maximum="100")",
                                 R"(name="KP" id="2" type="DOUBLE" init="7" minimum="0" maximum="200")");
const std::string faster = edited(R"(id="4711" interval="500")", R"(id="4711" interval="50")");

struct DescriptorChanges : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor};

  [[nodiscard]] MemoryHandle memory_of(const std::string& text, bool seal = true) {
    const MemoryHandle handle = rig.memory.create("text", text.size()).value();
    std::memcpy(rig.memory.map(handle, Access::ReadWrite).value().octets.data(), text.data(), text.size());
    if (seal) {
      EXPECT_TRUE(rig.memory.seal_writers(handle));
    }
    return handle;
  }
  [[nodiscard]] std::string outcome_of(testing::Sent sent) {
    rig.settle();
    return rig.outcome(sent);
  }
  [[nodiscard]] std::string judge(const std::string& text) {
    std::array<std::byte, 4> octets;
    OctetWriter{octets}.put(static_cast<std::uint32_t>(text.size()));
    return outcome_of(rig.send(130, DescriptorService::judge_text, octets, memory_of(text)));
  }
  [[nodiscard]] std::string take() { return outcome_of(rig.send(130, DescriptorService::take_text, {})); }
  [[nodiscard]] std::string reread(const std::string& text) {
    const std::string judged = judge(text);
    return judged == "1 3 7" ? take() : judged;
  }
  [[nodiscard]] std::string set(std::uint8_t id, double value) {
    std::vector<std::byte> data(13);
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, id}.wire()).put(value);
    return outcome_of(rig.send(20, 3, data));
  }
  /// DESCRIPTOR as TM[20,2] tells it.
  [[nodiscard]] std::string told() {
    std::array<std::byte, 5> data;
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{10, Type::Struct, 36}.wire());
    EXPECT_EQ(outcome_of(rig.send(20, 1, data)), "1 3 7");
    return rig.reports(20, 2).back();
  }
  [[nodiscard]] static std::string hash_of(const std::string& text, int changes) {
    std::array<std::byte, 6> data;
    OctetWriter{data}.put(crc32(std::as_bytes(std::span{text}))).put(static_cast<std::uint16_t>(changes));
    return testing::hex(data);
  }
};

TEST_F(DescriptorChanges, ARangeIsInForceAtOnceInPreOperational) {
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(set(2, 150), StartsWith("1 4"));
  EXPECT_EQ(reread(wider), "1 3 7");
  EXPECT_EQ(set(2, 150), "1 3 7");
  EXPECT_EQ(probe.kp.load(), 150.0);
  EXPECT_THAT(set(2, 201), StartsWith("1 4"));
}

TEST_F(DescriptorChanges, AnInitialValueBeginsTheNextSoftwareInit) {
  EXPECT_EQ(reread(wider), "1 3 7");
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(probe.kp.load(), 7.0);
  EXPECT_EQ(reread(probe_descriptor), "1 3 7");
  EXPECT_EQ(probe.kp.load(), 7.0) << "nobody sets it";
  rig.set_state_now(State::Offline);
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(probe.kp.load(), 3.0);
}

TEST_F(DescriptorChanges, AnInitialValueThatIsGoneIsZero) {
  EXPECT_EQ(reread(edited(R"(init="3" )", "")), "1 3 7");
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(probe.kp.load(), 0.0);
}

TEST_F(DescriptorChanges, AFailureCodeThatIsNewHasItsNameAtOnce) {
  const std::size_t before = rig.descriptor().failures.size();
  EXPECT_EQ(reread(edited("<Parameters>", R"(<Failure code="0x8123" name="FRESH"/><Parameters>)")), "1 3 7");
  ASSERT_EQ(rig.descriptor().failures.size(), before + 1);
  EXPECT_TRUE(std::ranges::any_of(rig.descriptor().failures, [](const auto& each) { return each.name == "FRESH"; }));
}

TEST_F(DescriptorChanges, HousekeepingIsThatOfTheNextConfigure) {
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(reread(faster), "1 3 7");
  rig.configure_now(1);
  rig.forget_telemetry();
  for (int i = 0; i < 51; ++i) {
    rig.cycle();
    rig.service();
  }
  EXPECT_EQ(rig.reports(3, 25).size(), 1U);
}

TEST_F(DescriptorChanges, AnEndnodeIsThatOfTheNextConfigure) {
  const auto device = rig.flows.open({Transfer::SharedMemory, "other"}, FlowSide::Device).value();
  EXPECT_EQ(reread(edited(R"(address="arm")", R"(address="other")")), "1 3 7");
  rig.bring_to(State::PreOperational, 3);
  rig.cycle(4);
  std::array<std::byte, 256> frame;
  EXPECT_GT(device->receive(frame).value().octets, 0U) << "what it is told comes here";
}

TEST_F(DescriptorChanges, WhatTheConfigurationInForceIsMadeOfWaitsAndRangesDoNot) {
  rig.set_state_now(State::PreOperational);
  rig.configure_now(1);
  EXPECT_THAT(reread(faster), StartsWith("1 4"));
  EXPECT_EQ(reread(wider), "1 3 7");
  EXPECT_EQ(set(2, 150), "1 3 7");
  EXPECT_THAT(told(), ::testing::EndsWith(hash_of(wider, 1))) << "while a cycle runs, too";
}

TEST_F(DescriptorChanges, AreRefusedWhereControlRuns) {
  for (const State state : {State::SafeOperational, State::Operational, State::ErrorOperational}) {
    rig.bring_to(state);
    EXPECT_THAT(judge(wider), StartsWith("1 4")) << to_text(state);
    EXPECT_THAT(take(), StartsWith("1 4")) << to_text(state);
    if (state == State::Operational) rig.set_state_now(State::SafeOperational);
    rig.set_state_now(State::Offline);
  }
  EXPECT_EQ(probe.kp.load(), 3.0);
}

TEST_F(DescriptorChanges, OneThatWasJudgedIsNotTakenWhereControlRunsByThen) {
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(judge(wider), "1 3 7");
  rig.configure_now(1);
  rig.set_state_now(State::SafeOperational);
  EXPECT_THAT(take(), StartsWith("1 4"));
  EXPECT_THAT(set(2, 150), StartsWith("1 4"));
}

TEST_F(DescriptorChanges, OneBehindWhichAnotherWasRefusedIsNotTakenInItsPlaceAnyMore) {
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(judge(wider), "1 3 7");
  rig.configure_now(1);
  rig.set_state_now(State::SafeOperational);
  EXPECT_THAT(judge(faster), StartsWith("1 4"));
  rig.set_state_now(State::Offline);
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(take(), StartsWith("1 4")) << "the text that was judged last was refused";
  EXPECT_THAT(told(), ::testing::EndsWith(hash_of(probe_descriptor, 0)));
}

TEST_F(DescriptorChanges, ABadEditLeavesTheOldOneActiveAndSaysWhere) {
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(reread(edited(R"(maximum="100")", R"(maximum="much")")), StartsWith("1 4"));
  ASSERT_THAT(rig.explanations, Not(IsEmpty()));
  EXPECT_THAT(rig.explanations.back(), HasSubstr("PROBE: 9: "));
  EXPECT_THAT(reread("<Subsystem"), StartsWith("1 4"));
  EXPECT_THAT(reread(edited(R"(name="SET_GOAL")", R"(name="SET_AIM")")), StartsWith("1 4"));
  EXPECT_THAT(take(), StartsWith("1 4")) << "nothing waits";
  EXPECT_THAT(set(2, 150), StartsWith("1 4"));
  EXPECT_EQ(set(2, 50), "1 3 7");
}

TEST_F(DescriptorChanges, OnlySealedMemoryOfTheRightSizeIsRead) {
  std::array<std::byte, 4> octets;
  OctetWriter{octets}.put(static_cast<std::uint32_t>(wider.size()));
  EXPECT_THAT(outcome_of(rig.send(130, DescriptorService::judge_text, octets, memory_of(wider, false))),
              StartsWith("1 4"));
  EXPECT_THAT(outcome_of(rig.send(130, DescriptorService::judge_text, octets)), StartsWith("1 4"));
  OctetWriter{octets}.put(static_cast<std::uint32_t>(wider.size() + 1));
  EXPECT_THAT(outcome_of(rig.send(130, DescriptorService::judge_text, octets, memory_of(wider))), StartsWith("1 4"));
}

TEST_F(DescriptorChanges, AValueThatIsThereIsSetBeforeItsRangeLeavesIt) {
  rig.set_state_now(State::PreOperational);
  ASSERT_EQ(set(2, 90), "1 3 7");
  const std::string narrower = edited(R"(maximum="100" writable)", R"(maximum="50" writable)");
  EXPECT_THAT(reread(narrower), StartsWith("1 4"));
  ASSERT_EQ(set(2, 40), "1 3 7");
  EXPECT_EQ(reread(narrower), "1 3 7");
}

/// The text comes between what was told as set and the cycle that sets it.
TEST_F(DescriptorChanges, AValueThatWaitsForTheCycleKeepsItsRangeToo) {
  rig.set_state_now(State::PreOperational);
  rig.configure_now(1);
  ASSERT_EQ(judge(edited(R"(maximum="100" writable)", R"(maximum="50" writable)")), "1 3 7");
  std::array<std::byte, 13> data;
  OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, 2}.wire()).put(90.0);
  const auto sent = rig.send(20, 3, data), taken = rig.send(130, DescriptorService::take_text, {});
  rig.service();
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
  EXPECT_THAT(rig.outcome(taken), StartsWith("1 4:0107"));
  rig.cycle();
  EXPECT_EQ(probe.kp.load(), 90.0);
  EXPECT_EQ(set(2, 95), "1 3 7") << "the range before";
}

TEST_F(DescriptorChanges, WhichOneIsInForceIsHousekeeping) {
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(told(), ::testing::EndsWith(hash_of(probe_descriptor, 0)));
  ASSERT_EQ(reread(wider), "1 3 7");
  EXPECT_THAT(told(), ::testing::EndsWith(hash_of(wider, 1)));
  rig.set_state_now(State::Offline);
  rig.set_state_now(State::PreOperational);
  EXPECT_THAT(told(), ::testing::EndsWith(hash_of(wider, 1)));
}

TEST(PersistentValues, OutliveADescriptorAndKeepItsRangeFromLeavingThem) {
  const std::string with_kd =
      edited(R"(<ParamRef name="KD" id="3" )", R"(<ParamRef name="KD" id="3" persistent="yes" )");
  Probe probe;
  Rig rig{probe, with_kd};
  rig.set_state_now(State::PreOperational);
  probe.kd.store(60);
  rig.set_state_now(State::Offline);
  const auto hand = [&](const std::string& text) {
    const MemoryHandle handle = rig.memory.create("text", text.size()).value();
    std::memcpy(rig.memory.map(handle, Access::ReadWrite).value().octets.data(), text.data(), text.size());
    EXPECT_TRUE(rig.memory.seal_writers(handle));
    std::array<std::byte, 4> octets;
    OctetWriter{octets}.put(static_cast<std::uint32_t>(text.size()));
    rig.send(130, DescriptorService::judge_text, octets, handle);
    const auto taken = rig.send(130, DescriptorService::take_text, {});
    rig.settle();
    return rig.outcome(taken);
  };
  EXPECT_THAT(hand(edited(R"(init="4" minimum="0" maximum="100")", R"(init="4" minimum="0" maximum="50")", with_kd)),
              StartsWith("1 4"));
  EXPECT_EQ(hand(edited(R"(init="4")", R"(init="5")", with_kd)), "1 3 7");
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(probe.kd.load(), 60.0);
}

}  // namespace
}  // namespace hirosco
