// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "switch.hpp"

#include <gtest/gtest.h>

#include <array>
#include <hirosco/descriptor/read/read.hpp>
#include <hirosco/subsystem/testing/rig.hpp>
#include <utility>

using namespace hirosco;

namespace {

/// Of the supervisor's descriptor what the switch asks and hears of it.
constexpr const char* supervisor = R"(<Subsystem name="SUPERVISOR" id="1">
  <ParamRef name="MODE" id="0" type="UINT8"/>
  <FunctionService><Function name="SET_MODE"><Argument name="MODE" type="UINT8" minimum="1" maximum="255"/></Function></FunctionService>
  <Configuration name="NOMINAL" id="1" sampling_us="10000">
    <HKService id="4701" interval="100"><SampledOnce><ParamRef name="MODE"/></SampledOnce></HKService>
  </Configuration>
</Subsystem>)";

descriptor::SubsystemDescriptor described() {
  const auto files = descriptor::file_system();
  return hirosco::testing::read_descriptor(files("switch.xml").value(), {files("lamp.xml").value(), supervisor});
}

}  // namespace

/// The test plays the supervisor and the lamp.
TEST(Switch, IsDoneWithAPressWhenTheLampIsAndSaysWhyNot) {
  const auto author = make_switch();
  hirosco::testing::Rig rig{*author, described()};
  rig.bring_to(State::PreOperational);
  ASSERT_EQ(rig.asked.size(), 2U) << "what it hears";
  for (const auto& each : std::exchange(rig.asked, {})) rig.verify(each, 7);
  rig.settle();
  std::vector<std::byte> bright(sizeof(double));
  OctetWriter{bright}.put(0.75);

  const auto first = rig.send(201, 1, bright);
  rig.settle();
  ASSERT_EQ(rig.asked.size(), 1U);
  EXPECT_EQ(rig.outcome(first), "1 3");
  rig.verify(rig.asked[0], 1);
  rig.verify(rig.asked[0], 7);
  rig.settle();
  EXPECT_EQ(rig.outcome(first), "1 3 7");

  const auto second = rig.send(201, 1, bright);
  rig.settle();
  const std::array wrong_state{std::byte{0}, std::byte{10}, std::byte{4}};
  rig.verify(rig.asked.at(1), 2, wrong_state);
  rig.settle();
  const std::string words = "not permitted in this state";
  EXPECT_NE(rig.outcome(second).find(hirosco::testing::hex(std::as_bytes(std::span{words}))), std::string::npos);
}

TEST(Switch, SeesHowBrightTheLampIsAndLooksWhenItWasProgrammed) {
  const auto author = make_switch();
  hirosco::testing::Rig rig{*author, described()};
  rig.bring_to(State::Operational);
  for (const auto& each : std::exchange(rig.asked, {})) rig.verify(each, 7);
  constexpr std::uint16_t lamp = 7, structure = 4800, programmed = 4801;
  std::vector<std::byte> values(2 + 2 * sizeof(double));
  OctetWriter{values}.put(structure).put(0.25).put(0.1);
  rig.answer(lamp, 3, 25, values, std::uint16_t{0});
  std::vector<std::byte> event(2 + 8 + 1 + 1 + 3 * sizeof(float));
  OctetWriter{event}.put(programmed).put(std::uint64_t{5}).put(std::uint8_t{1}).put(std::uint8_t{0});
  rig.answer(lamp, 5, 1, event);
  rig.settle();
  ASSERT_EQ(rig.asked.size(), 1U);
  EXPECT_EQ(hirosco::testing::hex(rig.asked[0].data), "0112c0") << "one shot of 4800";
  rig.forget_telemetry();
  for (int i = 0; i < 12; ++i) rig.settle(1);
  ASSERT_FALSE(rig.reports(3, 25).empty());
  // 4810, ANSWERS, then SEEN: 0.25, one report, one program.
  EXPECT_EQ(rig.reports(3, 25).back(),
            "12ca"
            "000000000000000000000000"
            "3fd0000000000000"
            "00000001"
            "00000001"
            "00");
}

TEST(Switch, AsksTheSupervisorForAModeAndIsDoneWhenThatIsThere) {
  const auto author = make_switch();
  hirosco::testing::Rig rig{*author, described()};
  rig.bring_to(State::PreOperational);
  for (const auto& each : std::exchange(rig.asked, {})) rig.verify(each, 7);
  rig.settle();
  const std::array mode{std::byte{3}};
  const auto asked = rig.send(201, 2, mode);
  rig.settle();
  ASSERT_EQ(rig.asked.size(), 1U);
  EXPECT_EQ(hirosco::testing::hex(rig.asked[0].data).substr(32), "010103") << "one argument, the first, 3";
  EXPECT_EQ(rig.outcome(asked), "1 3");
  for (const std::uint8_t subtype : std::array<std::uint8_t, 3>{1, 3, 7}) rig.verify(rig.asked[0], subtype);
  rig.settle();
  EXPECT_EQ(rig.outcome(asked), "1 3 7");
}
