// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/floating.hpp"

/// The floating arm as its subsystem, in JOINTS, where it takes its base as standing: here it does, and the test is its device. On a base that gives way
/// it is flown in missions/servicer/tests.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::testing::floating_descriptor;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct FloatingArmWay : robot_arm::testing::FloatingWay {};

TEST_F(FloatingArmWay, ThatWouldFoldItOntoItselfIsToldWithThePairWithin64CyclesAndNothingMoves) {
  begin(folded);
  expect_refused(move_tool(-0.35, 0, -0.35, 25), "link5 and link7");
  const auto away = move_tool(0.02, 0, 0.02, 2);
  flown.finish(away);
  EXPECT_EQ(flown.rig.outcome(away), "1 3 7");
}

/// In the middle of it: beside the last tube, which is clear of it before and would be behind.
TEST_F(FloatingArmWay, ThroughAVolumeIsToldWithThePairAndNothingMoves) {
  begin(ready);
  keep_out(tool() + robotics::Vector3{-0.05, 0.2, 0});
  expect_refused(move_tool(0, 0.4, 0, 25), "and a volume to keep out of");
}

/// What was judged meanwhile costs no time: 64 cycles later it would be 3 mm behind.
TEST_F(FloatingArmWay, ThatIsFreeIsGoneToItsEndInItsTime) {
  begin(ready);
  const robotics::Vector3 from = tool(), offset{0, 0.1, 0};
  const auto request = move_tool(0, 0.1, 0, 4);
  flown.cycle(1997);
  EXPECT_LT((tool() - from - offset / 2).norm(), 2.5e-3);
  flown.finish(request);
  EXPECT_EQ(flown.rig.outcome(request), "1 3 7");
  EXPECT_LT((tool() - from - offset).norm(), 1.5e-3);
}

/// Nobody knew of the volume when it began: what stops it before is there still.
TEST_F(FloatingArmWay, OnWhichAVolumeIsDeclaredMeanwhileIsStoppedBeforeIt) {
  begin(ready);
  const robotics::Vector3 from = tool();
  const auto request = move_tool(0, 0.4, 0, 25);
  flown.cycle(2000);
  keep_out(from + robotics::Vector3{-0.05, 0.3, 0});
  flown.finish(request);
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8:8009"));
  EXPECT_EQ(flown.rig.events(too_near_event), 1);
  flown.cycle(1000);
  EXPECT_LT(flown.plant.measured().velocity.cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmWay, IsGoneByNobodyWhoIsToldToHoldWhileItIsJudged) {
  begin(ready);
  for (const char* of : {"tool", "joints"}) {
    const auto request = of == std::string_view{"tool"} ? move_tool(0.02, 0, 0, 2) : move_joint(turned(0.5), 8);
    EXPECT_EQ(flown.rig.outcome(request), "1 3") << of;
    const auto hold = flown.rig.call("HOLD");
    flown.cycle(200);
    EXPECT_EQ(flown.rig.outcome(hold), "1 3 7") << of;
    EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8")) << of;
    flown.cycle(2000);
    EXPECT_LT(flown.fastest, 1e-6) << of;
  }
}

TEST(FloatingArmThatIsSlow, IsNotConfiguredWithACycleThatLeavesNoLaw) {
  std::string text = floating_descriptor();
  constexpr std::string_view cycle = "sampling_us=\"1000\"";
  text.replace(text.find(cycle), cycle.size(), "sampling_us=\"5000\"");
  const auto author = make_floating_arm();
  hirosco::testing::Rig rig{*author, text};
  ASSERT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_THAT(rig.configure_now(1), StartsWith("1 3 8:"));
  EXPECT_THAT(rig.explanations, ::testing::Contains(HasSubstr("sampling_us is too long")));
}

}  // namespace
}  // namespace hirosco
