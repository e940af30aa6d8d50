// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/testing/counting.hpp"

/// What holds an arm that homes, or has homed, where its device is silent about it, or what is declared of it is not so (docs/adr/0208, hazard R60).
namespace hirosco {
namespace {

using robot_arm::testing::all_found;
using robot_arm::testing::CountingArm;
using robot_arm::testing::homes;
using robot_arm::testing::not_referenced;
using robot_arm::testing::works_by_position;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::uint16_t does_not_follow = 1024;

struct RobotArmHomingBarriers : CountingArm {
  void expect_that_brakes_hold() {
    EXPECT_EQ(arm.rig.inhibited(), inhibited_by_author);
    EXPECT_EQ(arm.mode, DeviceMode::Off);
    EXPECT_EQ(arm.rig.events(does_not_follow), 1);
    EXPECT_EQ(arm.rig.events(not_referenced), 0);
  }
};

/// Where it is to be goes by no flag: a place that jumps is one that it does not follow.
TEST_F(RobotArmHomingBarriers, HoldAnArmWhoseDeviceForgetsItsZerosWithoutAWord) {
  arm.know_all_zeros();
  ASSERT_NO_FATAL_FAILURE(operate(works_by_position));
  arm.fly(100);
  arm.ahead.fill(0.9);
  arm.fly(10);
  expect_that_brakes_hold();
  EXPECT_LT(arm.off(start), 5e-3) << "as it truly stands";
}

TEST_F(RobotArmHomingBarriers, HoldAJointWhoseDeviceTellsAnotherPlaceWithoutAWordWhileItLooks) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(5));
  const double there = arm.plant.measured().position[4];
  arm.ahead[4] += 1;
  arm.fly(10);
  expect_that_brakes_hold();
  EXPECT_THAT(arm.rig.outcome(home), StartsWith("1 3 5:0001 8:8003"));
  EXPECT_THAT(arm.takes, Each(false));
  EXPECT_NEAR(arm.plant.measured().position[4], there, 5e-3);
}

/// Of those that have not been found yet no flag tells that they count anew.
TEST_F(RobotArmHomingBarriers, HoldAnArmThatLosesItsPowerWhileItLooksAndItIsHomedAgain) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(5));
  const auto there = arm.plant.measured().position;
  arm.lose_power();
  arm.fly(10);
  expect_that_brakes_hold();
  EXPECT_THAT(arm.rig.outcome(home), StartsWith("1 3 5:0001 8:8030"));
  EXPECT_LT(arm.off(there), 5e-3);
  arm.mark[5] = arm.plant.measured().position[5] - 0.05;
  ASSERT_NO_FATAL_FAILURE(enter(State::SafeOperational));
  ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
  EXPECT_EQ(arm.asked("HOME"), all_found);
}

/// Too little for that: it has all of its torque for it, and not for long.
TEST_F(RobotArmHomingBarriers, LetGoOfAJointThatIsToldToBeALittleElsewhereWithoutAWord) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(5));
  const double there = arm.plant.measured().position[4];
  arm.ahead[4] += 0.08;
  EXPECT_THAT(arm.asked(home), StartsWith("1 3 5:0001 8:8032"));
  EXPECT_THAT(arm.rig.outcome(home), HasSubstr(of_joint(5, "all of TORQUE of HOMING")));
  stands();
  EXPECT_NEAR(arm.plant.measured().position[4], there, 0.05);
}

TEST_F(RobotArmHomingBarriers, HoldAnArmThatWeighsSomethingThoughItIsSaidNotTo) {
  arm.plant.set_gravity({0, 0, -9.81});
  ASSERT_NO_FATAL_FAILURE(operate());
  for (int i = 0; i < 2000 && arm.rig.inhibited() == 0; ++i) arm.fly();
  arm.fly(2);
  expect_that_brakes_hold();
  EXPECT_LT(arm.off(start), 0.15);
}

TEST_F(RobotArmHomingBarriers, BoundTorqueByEachEffortWhateverIsWrittenBehindConfigure) {
  constexpr double effort_n_m = 28;
  ASSERT_NO_FATAL_FAILURE(bring_up(homes));
  ASSERT_EQ(arm.write_torque({15, 15, 12, 5, 30, 5}), "1 3 7") << ::testing::PrintToString(arm.rig.explanations);
  EXPECT_THAT(self_tested(), HasSubstr(of_joint(5, "TORQUE of HOMING is 0 or above its effort")));
  ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
  EXPECT_THAT(arm.asked("HOME"), StartsWith("1 4:8033"));
  arm.wall = start[4] - 0.1;
  double hardest = 0;
  for (int i = 0; i < 30; ++i) {
    arm.fly();
    hardest = std::max(hardest, std::abs(arm.commanded[4]));
  }
  EXPECT_GT(hardest, 20);
  EXPECT_LE(hardest, effort_n_m);
}

/// Another arm that follows ARM_STATE goes by ACTIVE.
TEST_F(RobotArmHomingBarriers, KeepAnArmThatHomesFromLeadingAndSayWhoLooks) {
  ASSERT_NO_FATAL_FAILURE(operate());
  static_cast<void>(arm.rig.call("HOME"));
  ASSERT_NO_FATAL_FAILURE(until_looks_with(5));
  EXPECT_EQ(arm.told_octet("HOMING_JOINT"), 5);
  EXPECT_EQ(arm.told_octet("ACTIVE"), 0);
  const auto down = arm.rig.set_state(State::ErrorOperational);
  arm.fly(5);
  EXPECT_EQ(arm.rig.outcome(down), "1 3 7");
  EXPECT_EQ(arm.told_octet("HOMING_JOINT"), 0);
}

TEST_F(RobotArmHomingBarriers, LetAnArmLeadThatKnowsItsZeros) {
  arm.know_all_zeros();
  ASSERT_NO_FATAL_FAILURE(operate(works_by_position));
  EXPECT_EQ(arm.told_octet("ACTIVE"), 1);
}

}  // namespace
}  // namespace hirosco
