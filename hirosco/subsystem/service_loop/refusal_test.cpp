// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "hirosco/pus/words/describe.hpp"
#include "hirosco/subsystem/service_loop/open_calls.hpp"
#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// An author's reasons reach ground, and what has no effect is refused.
namespace hirosco {
namespace {

using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;
using ::testing::StartsWith;

constexpr const char* refuser_descriptor = R"(<Subsystem name="REFUSER" id="10">
  <Failure code="0x8001" name="SENSOR_BROKEN"/>
  <FunctionService>
    <Function name="OWN"/><Function name="WORDS"/><Function name="UNNAMED"/><Function name="LATER"/>
  </FunctionService>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)";

struct Refuser final : Subsystem {
  enum class Trouble : std::uint16_t { sensor_broken = 0x8001, nameless = 0x8002 };
  std::optional<Call> later;
  bool configuration_fails{false};

  Result<Step> software_init() override {
    on_function("OWN", []() -> Outcome { return refused(Trouble::sensor_broken, "no answer", -7); });
    on_function("WORDS", []() -> Result<> { return fail(ErrorCode::Unavailable, "sensor is broken", 42); });
    on_function("UNNAMED", []() -> Outcome { return refused(Trouble::nameless); });
    on_function("LATER", [this](Call call) -> Outcome {
      later = call;
      return running;
    });
    return done;
  }
  Result<> configure(const descriptor::Configuration&) override {
    return configuration_fails ? fail(ErrorCode::Timeout, "no power", 3) : ok();
  }
  Result<> operational(const Cycle&) noexcept override {
    if (later) abort(*later, Trouble::sensor_broken, "it fell off", 5);
    later.reset();
    return ok();
  }
};

/// Its calls run until it is told.
struct Untiring final : Subsystem {
  std::vector<Call> calls;
  bool ends_one{false};
  Result<Step> software_init() override {
    on_function("LATER", [this](Call call) -> Outcome {
      calls.push_back(call);
      return running;
    });
    return done;
  }
  Result<> operational(const Cycle&) noexcept override {
    if (std::exchange(ends_one, false)) finish(calls.front());
    return ok();
  }
};

TEST(RunningFunctions, AreSoManyAndAnotherIsRefusedUntilOneHasEnded) {
  Untiring author;
  Rig rig{author, R"(<Subsystem name="UNTIRING" id="10">
  <FunctionService><Function name="LATER"/></FunctionService>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)"};
  author.calls.reserve(OpenCalls::most + 1);
  rig.bring_to(State::Operational);
  const auto call = [&] {
    const auto sent = rig.call("LATER");
    rig.settle();
    return rig.outcome(sent);
  };
  for (std::size_t i = 0; i < OpenCalls::most; ++i) ASSERT_EQ(call(), "1 3") << i;
  EXPECT_THAT(call(), ::testing::EndsWith(":000b")) << "as of a full queue";
  EXPECT_EQ(author.calls.size(), OpenCalls::most);
  author.ends_one = true;
  rig.settle();
  EXPECT_EQ(call(), "1 3");
}

struct Refusals : ::testing::Test {
  Refuser author;
  Rig rig{author, refuser_descriptor};

  /// The newest failure report: subtype, code, and its reason in words.
  std::string failure(std::string_view function) {
    rig.forget_telemetry();
    rig.call(function);
    rig.settle();
    return newest();
  }
  std::string newest() {
    for (const auto& report : rig.telemetry)
      if (report.service == 1 && report.subtype % 2 == 0) {
        OctetReader reader{report.data};
        static_cast<void>(reader.get<std::uint32_t>());
        const auto code = reader.get<std::uint16_t>();
        std::string text = std::to_string(report.subtype) + " " + std::to_string(code);
        const auto reason = pus::reason_in(reader.rest());
        return reason ? text + " " + std::string{reason->text} + " " + std::to_string(reason->number) : text;
      }
    return "none";
  }
};

TEST_F(Refusals, CarryTheAuthorsCodeWordsAndNumber) {
  rig.bring_to(State::Operational);
  EXPECT_EQ(failure("OWN"), "4 32769 no answer -7");
  EXPECT_EQ(failure("WORDS"), "4 517 sensor is broken 42");
  EXPECT_EQ(failure("LATER"), "8 32769 it fell off 5");
}

TEST_F(Refusals, WithACodeThatTheDescriptorDoesNotNameSaySo) {
  rig.bring_to(State::Operational);
  EXPECT_EQ(failure("UNNAMED"), "4 514 failure code without a name in the descriptor 32770");
}

TEST_F(Refusals, OfAConfigurationReachReportAndEvent) {
  rig.bring_to(State::PreOperational, 0);
  author.configuration_fails = true;
  rig.forget_telemetry();
  rig.configure_now(1);
  EXPECT_EQ(newest(), "8 514 no power 3");
  ASSERT_EQ(rig.heard(descriptor::framework_event::configuration_failed), 1);
  OctetReader reader{rig.raised.back().auxiliary};
  EXPECT_EQ(reader.get<std::uint8_t>(), 1);
  EXPECT_EQ(reader.get<std::uint8_t>(), static_cast<std::uint8_t>(ErrorCode::Timeout));
  EXPECT_EQ(reader.get<std::int64_t>(), 3);
  EXPECT_THAT(pus::text_of(reader.rest()), "no power");
}

TEST(ParameterWrites, ThatTheNextCycleWouldOverwriteAreRefused) {
  Probe probe;
  std::string text = probe_descriptor;
  const auto amend = [&](const std::string& declared, const std::string& with) {
    text.replace(text.find(declared), declared.size(), declared + with);
  };
  amend(R"(<StructRef name="CUR_VALUES" id="0" type="STRUCT")", R"( writable="Operational")");
  amend(R"(<ParamRef name="STATE" id="0" type="INT32")", R"( minimum="0" maximum="9")");
  amend(R"(<ParamRef name="POSITION" id="0" type="DOUBLE")", R"( minimum="-100" maximum="100")");
  Rig rig{probe, text};
  rig.bring_to(State::Operational);
  // CUR_VALUES: the probe stores it in every cycle.
  std::vector<std::byte> data(64);
  OctetWriter writer{data};
  writer.put(std::uint8_t{1}).put(ParameterId{10, Type::Struct, 0}.wire()).put(std::int32_t{1}).put(2.0);
  const auto overwritten = rig.send(20, 3, Octets{data}.first(writer.size()));
  rig.settle();
  EXPECT_THAT(rig.outcome(overwritten), StartsWith("1 4:0107"));
  OctetWriter again{data};
  again.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, 2}.wire()).put(7.0);
  const auto lasting = rig.send(20, 3, Octets{data}.first(again.size()));
  rig.settle();
  EXPECT_EQ(rig.outcome(lasting), "1 3 7");
  EXPECT_EQ(probe.kp.load(), 7.0);
  const CycleLoop& cycle = rig.subsystem.cycle();
  EXPECT_TRUE(cycle.writes_itself(0));
  EXPECT_FALSE(cycle.writes_itself(2));
  EXPECT_FALSE(cycle.writes_itself(99)) << "nobody declared it";
  rig.set_state_now(State::ErrorOperational);
  rig.set_state_now(State::PostOperational);
  rig.set_state_now(State::PreOperational);
  rig.configure(1);
  rig.service();
  EXPECT_FALSE(cycle.writes_itself(0)) << "no cycle of this configuration has run";
}

TEST(ParameterWrites, InAStateThatTheDescriptorDoesNotNameAreRefused) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  const auto set = [&](std::uint8_t id) {
    std::vector<std::byte> data(64);
    OctetWriter writer{data};
    writer.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, id}.wire()).put(7.0);
    const auto request = rig.send(20, 3, Octets{data}.first(writer.size()));
    rig.settle();
    return rig.outcome(request);
  };
  constexpr std::uint8_t kp = 2, des_position = 1;
  rig.bring_to(State::Operational);
  EXPECT_EQ(set(kp), "1 3 7");
  EXPECT_THAT(set(des_position), StartsWith("1 4:0107")) << "it names no state at all";
  rig.set_state_now(State::ErrorOperational);
  EXPECT_THAT(set(kp), StartsWith("1 4:0107"));
}

/// What the cycle would set behind the entry is judged by the state that is entered, too.
TEST(ParameterWrites, BehindTheOrderIntoAStateThatDoesNotPermitThemAreRefused) {
  Probe probe;
  std::string text = probe_descriptor;
  const std::string all = R"(writable="PreOperational SafeOperational Operational")";
  text.replace(text.find(all), all.size(), R"(writable="PreOperational")");
  Rig rig{probe, text};
  const auto set = [&](std::uint8_t id) {
    std::array<std::byte, 13> data;
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{10, Type::Double, id}.wire()).put(7.0);
    return rig.send(20, 3, data);
  };
  constexpr std::uint8_t of_before = 2, of_both = 3;
  rig.bring_to(State::PreOperational);
  const auto entered = rig.set_state(State::SafeOperational);
  rig.service();
  const auto before = set(of_before), both = set(of_both);
  rig.settle();
  EXPECT_EQ(rig.outcome(entered), "1 3 7");
  EXPECT_THAT(rig.outcome(before), StartsWith("1 4:0107"));
  EXPECT_EQ(rig.outcome(both), "1 3 7");
  EXPECT_EQ(probe.kp.load(), 3.0);
  EXPECT_EQ(probe.kd.load(), 7.0);
  for (const State state : {State::PostOperational, State::PreOperational}) rig.set_state_now(state);
  const auto again = set(of_before);
  rig.settle();
  EXPECT_EQ(rig.outcome(again), "1 3 7") << "it is there";
}

/// Nobody could tell whose request it was (docs/failure-codes.md, docs/interfaces/packets.md).
TEST(WhatIsNoTelecommandAtAll, IsPassedOverInSilence) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.forget_telemetry();
  std::array<std::byte, 32> buffer{};
  const auto packet = pus::write_telecommand(buffer, {.apid = 10, .service = 17, .subtype = 1}, {}).value();
  const auto said_of = [&](std::byte flipped) {
    buffer[0] ^= flipped;
    EXPECT_TRUE(rig.channels.supervisor_end().send({.packet = packet}));
    buffer[0] ^= flipped;
    rig.service();
    return rig.telemetry.size();
  };
  EXPECT_EQ(said_of(std::byte{0x20}), 0U) << "another packet version";
  EXPECT_GT(said_of(std::byte{0x01}), 0U) << "another APID is one, and is refused";
}

TEST(FailedPostOperational, GivesBackConfigurationPlanAndFlowsWhenTheCycleHasComeToRest) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::PreOperational, 3);
  const auto down = rig.set_state(State::PostOperational);
  rig.service();  // the cycle is told to rest, and hangs
  rig.advance(11s);
  for (int i = 0; i < 5; ++i) rig.service();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_THAT(rig.outcome(down), StartsWith("1 3 8:0202"));
  EXPECT_EQ(rig.vital.configuration.load(), 3u) << "the cycle may still be using it";
  const auto early = rig.set_state(State::PreOperational);
  rig.service();
  EXPECT_EQ(rig.outcome(early), "1 4:0108");
  rig.cycle();  // it rests at last
  rig.service();
  EXPECT_EQ(rig.vital.configuration.load(), 0u);
  const auto arm = rig.flows.open({Transfer::SharedMemory, "arm"}, FlowSide::Subsystem);
  EXPECT_TRUE(arm) << "its data flow is free for the next";
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
}

}  // namespace
}  // namespace hirosco
