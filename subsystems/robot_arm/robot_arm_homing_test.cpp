// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "subsystems/robot_arm/testing/counting.hpp"

/// How an arm finds its zeros, and that it does not act by its model before; what holds it where that fails: robot_arm_homing_barriers_test.cpp.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::testing::all_found;
using robot_arm::testing::counted_joints;
using robot_arm::testing::Counting;
using robot_arm::testing::CountingArm;
using robot_arm::testing::descriptor_for;
using robot_arm::testing::descriptor_text;
using robot_arm::testing::homed_arm;
using robot_arm::testing::homed_file;
using robot_arm::testing::homes;
using robot_arm::testing::homing_numbers;
using robot_arm::testing::not_referenced;
using robot_arm::testing::replace_all;
using robot_arm::testing::under_gravity;
using robot_arm::testing::with_homing;
using robot_arm::testing::works_by_position;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct RobotArmHoming : CountingArm {
  using CountingArm::CountingArm;
};

TEST_F(RobotArmHoming, FindsItsZerosOneByOneInItsOrderAndTheOthersStand) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  JointVector stood = start;
  std::vector<std::size_t> order;
  double fastest = 0;
  std::array<bool, counted_joints> knew{};
  for (int i = 0; i < 20'000 && !arm.has_ended(home); ++i) {
    arm.fly();
    fastest = std::max(fastest, arm.fastest_joint());
    const JointVector& here = arm.plant.measured().position;
    for (std::size_t joint = 0; joint < counted_joints; ++joint) {
      const auto k = static_cast<Eigen::Index>(joint);
      if (arm.knows.at(joint) && !knew.at(joint)) order.push_back(joint + 1);
      // Whoever looks, or has found its zero and comes to rest, moves.
      if (arm.takes.at(joint) || arm.knows.at(joint)) stood[k] = here[k];
      ASSERT_NEAR(here[k], stood[k], 5e-3) << joint;
    }
    knew = arm.knows;
  }
  EXPECT_EQ(arm.rig.outcome(home), all_found) << ::testing::PrintToString(arm.rig.explanations);
  EXPECT_EQ(order, (std::vector<std::size_t>{6, 5, 4, 3, 2, 1}));
  EXPECT_LT(fastest, 0.2);
  EXPECT_LT((arm.told_position - arm.plant.measured().position).cwiseAbs().maxCoeff(), 1e-12);
  stands();
  EXPECT_EQ(arm.asked("HOME"), "1 3 7") << "all know their zero already";
}

TEST_F(RobotArmHoming, GoesByItsModelThenInAnotherConfigurationWithoutBeingStartedAnew) {
  ASSERT_NO_FATAL_FAILURE(operate());
  ASSERT_EQ(arm.asked("HOME"), all_found);
  ASSERT_NO_FATAL_FAILURE(act_by(works_by_position));
  EXPECT_EQ(arm.rig.inhibited(), 0u);
  EXPECT_EQ(arm.rig.events(not_referenced), 0);
  const auto motion = arm.move_j(start, 0.5);
  EXPECT_EQ(arm.asked(motion), "1 3 5:0001 7");
  EXPECT_LT(arm.off(start), 1e-3);
}

/// POSITION jumps by up to 2.5 rad then.
TEST_F(RobotArmHoming, MakesNoStepInTorqueWhereAJointFindsItsZero) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  std::array<bool, counted_joints> knew{};
  JointVector last = arm.commanded;
  int since = 1000, found = 0;
  double steepest = 0;
  for (int i = 0; i < 20'000 && !arm.has_ended(home); ++i) {
    arm.fly();
    ++since;
    if (arm.knows != knew) since = 0, ++found;
    // What is told now is answered in the next two cycles.
    if (since <= 3) steepest = std::max(steepest, (arm.commanded - last).cwiseAbs().maxCoeff());
    knew = arm.knows;
    last = arm.commanded;
  }
  EXPECT_EQ(found, 6);
  EXPECT_LT(steepest, 0.5);
  EXPECT_EQ(arm.rig.inhibited(), 0u);
}

TEST_F(RobotArmHoming, EndsWithTheNumberOfAJointThatHasNoMarkAndGoesOnWhereItHasOne) {
  arm.has_mark[3] = false;
  ASSERT_NO_FATAL_FAILURE(operate());
  const std::string outcome = arm.asked("HOME");
  EXPECT_THAT(outcome, StartsWith("1 3 5:0001 5:0002 8:8031"));
  EXPECT_THAT(outcome, HasSubstr(of_joint(4, "no mark")));
  EXPECT_THAT(arm.takes, Each(false));
  stands();
  EXPECT_NEAR(arm.plant.measured().position[3] - start[3], 0.4, 0.03);
  arm.has_mark[3] = true;
  arm.mark[3] = arm.plant.measured().position[3] + 0.05;
  EXPECT_EQ(arm.asked("HOME"), "1 3 5:0001 5:0002 5:0003 5:0004 7");
}

TEST_F(RobotArmHoming, StandsBeforeWhatIsInTheWayAndPressesNoHarderThanItsTorque) {
  arm.wall = start[4] + 0.02;
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  double hardest = 0;
  for (int i = 0; i < 20'000 && !arm.has_ended(home); ++i) {
    arm.fly();
    hardest = std::max(hardest, std::abs(arm.commanded[4]));
  }
  EXPECT_THAT(arm.rig.outcome(home), StartsWith("1 3 5:0001 8:8032"));
  EXPECT_THAT(arm.rig.outcome(home), HasSubstr(of_joint(5, "all of TORQUE of HOMING")));
  EXPECT_LE(hardest, 5);
  stands();
  EXPECT_LT(std::abs(arm.commanded[4]), 1) << "it presses on for nobody";
  EXPECT_FALSE(arm.knows[4]);
  arm.wall.reset();
  EXPECT_EQ(arm.asked("HOME"), "1 3 5:0001 5:0002 5:0003 5:0004 5:0005 7");
}

TEST_F(RobotArmHoming, IsEndedByHoldAndByStopAndGoesOnWithThoseThatAreLeft) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto first = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(5));
  EXPECT_EQ(arm.asked("HOLD"), "1 3 7");
  EXPECT_EQ(arm.rig.outcome(first), "1 3 5:0001 8:0204");
  EXPECT_THAT(arm.takes, Each(false));
  stands();
  const auto second = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(4));
  EXPECT_EQ(arm.asked("STOP"), "1 3 7");
  EXPECT_EQ(arm.rig.outcome(second), "1 3 5:0001 8:0204");
  arm.fly(5);
  EXPECT_EQ(arm.mode, DeviceMode::Off);
  EXPECT_THAT(arm.asked("HOME"), StartsWith("1 4:8006"));
  ASSERT_NO_FATAL_FAILURE(enter(State::SafeOperational));
  ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
  EXPECT_EQ(arm.asked("HOME"), "1 3 5:0001 5:0002 5:0003 5:0004 7");
}

TEST_F(RobotArmHoming, IsEndedByTheStopOfEverythingInTheNextCycle) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(5));
  arm.rig.fence();
  arm.fly(2);
  EXPECT_EQ(arm.mode, DeviceMode::Off);
  EXPECT_THAT(arm.takes, Each(false));
  EXPECT_THAT(arm.rig.outcome(home), StartsWith("1 3 5:0001 8:"));
}

TEST_F(RobotArmHoming, IsEndedWhereAJointLosesItsZeroMeanwhileAndSaysWhich) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(5));
  arm.knows[5] = false;
  arm.ahead[5] = 1.5;
  arm.fly(5);
  EXPECT_THAT(arm.rig.outcome(home), StartsWith("1 3 5:0001 8:8030"));
  EXPECT_THAT(arm.rig.outcome(home), HasSubstr(of_joint(6, "it lost its zero")));
  stands();
  arm.mark[5] = arm.plant.measured().position[5] - 0.05;
  EXPECT_EQ(arm.asked("HOME"), all_found);
}

TEST_F(RobotArmHoming, WithoutPowerItIsNotKnownAgainAndNothingMovesByItsModel) {
  ASSERT_NO_FATAL_FAILURE(operate());
  ASSERT_EQ(arm.asked("HOME"), all_found);
  ASSERT_NO_FATAL_FAILURE(act_by(works_by_position));
  const auto motion = arm.move_j(start, 0.2);
  arm.fly(100);
  arm.lose_power();
  arm.fly();
  double hardest = 0;
  for (int i = 0; i < 10; ++i) {
    arm.fly();
    hardest = std::max(hardest, arm.commanded.cwiseAbs().maxCoeff());
    if (i == 0) {
      EXPECT_EQ(arm.mode, DeviceMode::Off) << "in the cycle that hears of it";
    }
  }
  EXPECT_EQ(hardest, 0);
  EXPECT_EQ(arm.rig.inhibited(), inhibited_by_author);
  EXPECT_EQ(arm.rig.events(not_referenced), 1);
  EXPECT_THAT(arm.rig.outcome(motion), HasSubstr("8:8030"));
  EXPECT_THAT(arm.rig.outcome(motion), HasSubstr(of_joint(1, "it does not know its zero")));
  ASSERT_NO_FATAL_FAILURE(enter(State::SafeOperational));
  EXPECT_THAT(self_tested(), HasSubstr("8:"));
  ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
  EXPECT_EQ(arm.rig.inhibited(), inhibited_by_author);
  EXPECT_EQ(arm.mode, DeviceMode::Off);
  EXPECT_EQ(arm.rig.events(not_referenced), 2);
  const auto next = arm.move_j(start, 0.2);
  arm.fly(3);
  EXPECT_THAT(arm.rig.outcome(next), StartsWith("1 4:8006"));
}

TEST_F(RobotArmHoming, IsRefusedInEveryOtherConfigurationWithTheJointThatDoesNotKnowItsZero) {
  arm.knows = {true, true, false, true, true, true};
  arm.ahead = {0, 0, 10, 0, 0, 0};
  ASSERT_NO_FATAL_FAILURE(bring_up(works_by_position));
  const std::string tested = self_tested();
  EXPECT_THAT(tested, HasSubstr("8:"));
  EXPECT_THAT(tested, HasSubstr(of_joint(3, "does not know its zero")));
  EXPECT_EQ(arm.rig.inhibited(), 0u) << "what it tells is beyond no range";
  ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
  EXPECT_EQ(arm.rig.inhibited(), inhibited_by_author);
  EXPECT_FALSE(arm.was_active) << "in no cycle";
  EXPECT_EQ(arm.rig.events(not_referenced), 1);
  EXPECT_THAT(arm.asked("HOME"), StartsWith("1 4:8034"));
}

TEST_F(RobotArmHoming, KeepsAConfigurationThatHomesForHomingAlone) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const std::vector<std::pair<const char*, std::vector<double>>> others{{"MOVE_J", {0, 0, 0, 0, 0, 0, 0.5}},
                                                                        {"MOVE_P", {0.5, 0, 0.5, 1, 0, 0, 0, 0.5}},
                                                                        {"JOG_J", {0.1, 0, 0, 0, 0, 0, 0.5}},
                                                                        {"TORQUE_J", {1, 0, 0, 0, 0, 0, 0.5}},
                                                                        {"IMPEDANCE_L", {500, 30, 1}},
                                                                        {"RETREAT", {0.1}},
                                                                        {"MOVE_ABORT", {0.25}},
                                                                        {"MOVE_L", {0.5, 0, 0.5, 1, 0, 0, 0, 0.1, 0.1}},
                                                                        {"JOG_L", {0.1, 0, 0, 0, 0, 0, 0.5}},
                                                                        {"IMPEDANCE_J", {9, 9, 9, 9, 9, 9, 1}},
                                                                        {"POSITION_CONTROL", {}},
                                                                        {"FLOAT", {}},
                                                                        {"CHECK_ABORT", {}},
                                                                        {"FOLLOW", {}}};
  for (const auto& [function, numbers] : others)
    EXPECT_THAT(arm.asked(arm.ask(function, numbers)), StartsWith("1 4:8034")) << function;
  stands();
}

TEST_F(RobotArmHoming, PassesItsSelfTestWithoutItsPosture) {
  arm.ahead.fill(50);
  ASSERT_NO_FATAL_FAILURE(bring_up(homes));
  EXPECT_EQ(self_tested(), "1 3 7") << ::testing::PrintToString(arm.rig.explanations);
}

/// What an arm weighs where its posture is not known nobody knows.
struct RobotArmHomingOnGround : RobotArmHoming {
  RobotArmHomingOnGround() : RobotArmHoming{on_ground()} {}
  [[nodiscard]] static std::string on_ground() {
    std::string text = homed_arm();
    replace_all(text, R"(unit="m/s2" init="0 0 0")", R"(unit="m/s2" init="0 0 -9.81")");
    return text;
  }
};

TEST_F(RobotArmHomingOnGround, IsRefusedAndNoBrakeOpens) {
  ASSERT_NO_FATAL_FAILURE(bring_up(homes));
  EXPECT_THAT(self_tested(), HasSubstr(hex_of("GRAVITY is not 0")));
  ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
  EXPECT_EQ(arm.rig.inhibited(), inhibited_by_author);
  EXPECT_FALSE(arm.was_active) << "in no cycle";
  EXPECT_EQ(arm.rig.events(under_gravity), 1);
  EXPECT_THAT(arm.asked("HOME"), StartsWith("1 4:8006"));
}

/// A descriptor that homes nobody, and what it is refused with.
struct UnfitToHome {
  const char* from;
  const char* to;
  const char* told;
};
struct RobotArmHomingRefuses : ::testing::TestWithParam<UnfitToHome> {};

TEST_P(RobotArmHomingRefuses, WhatHomesNobody) {
  const auto& [from, to, told] = GetParam();
  std::string text = homed_arm();
  ASSERT_NE(text.find(from), std::string::npos);
  replace_all(text, from, to);
  const auto subsystem = make_robot_arm();
  testing::Rig rig{*subsystem, text};
  const std::string up = rig.set_state_now(State::PreOperational);
  if (up == "1 3 7") {
    EXPECT_THAT(rig.configure_now(homes), StartsWith("1 3 8:"));
  }
  EXPECT_THAT(rig.explanations, Contains(HasSubstr(told)));
}

INSTANTIATE_TEST_SUITE_P(
    Descriptors, RobotArmHomingRefuses,
    ::testing::Values(
        UnfitToHome{"6 5 4 3 2 1", "6 5 4 3 2 2", "ORDER of HOMING does not name each joint once"},
        UnfitToHome{"0.1 0.1 -0.1", "0.1 0 -0.1", "SPEED of HOMING is 0 or above 1/4"},
        UnfitToHome{"15 15 12", "15 15 0", "TORQUE of HOMING is 0 or above its effort"},
        UnfitToHome{"0.4 0.4 0.4 0.4 0.4 0.4", "0.4 0.4 0.4 0.4 0.4 0", "DISTANCE of HOMING is 0"},
        UnfitToHome{"init=\"0.1 0.1 0.1 0.1 0.1 0.1\" minimum=\"0\" maximum=\"10\"",
                    "init=\"0.1 0.1 0 0.1 0.1 0.1\" minimum=\"0\" maximum=\"10\"", "homing goes by ROTOR_INERTIA"},
        UnfitToHome{"name=\"HOMING\" value=\"on\"", "name=\"HOMING\" value=\"yes\"", "HOMING of ARM is on, or"},
        UnfitToHome{R"(name="REFERENCED" id="66" type="UINT8" count="6")",
                    R"(name="REFERENCED" id="66" type="UINT8" count="5")",
                    "REFERENCED has another length than the robot has joints"},
        UnfitToHome{R"(name="REFERENCE" type="UINT8" count="6" minimum="0" maximum="1" safe="0 0 0 0 0 0")",
                    R"(name="REFERENCE" type="UINT8" count="5" minimum="0" maximum="1" safe="0 0 0 0 0")",
                    "REFERENCE has another length than the robot has joints"}));

TEST(RobotArmWithAbsoluteEncoders, HasNoHomingAndAConfigurationThatHomesIsRefused) {
  std::string text = descriptor_for(counted_joints, homed_file());
  replace_all(text, "value=\"tool\"/>", "value=\"tool\"/><Setting name=\"HOMING\" value=\"on\"/>");
  const auto subsystem = make_robot_arm();
  testing::Rig rig{*subsystem, text};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), ::testing::Not("1 3 7"));
  EXPECT_THAT(rig.explanations, Contains(HasSubstr("HOMING")));
}

TEST(ShippedArmThatHomes, ActsByItsModelOnlyOnceAllZerosAreKnown) {
  std::string text = with_homing(descriptor_text(), homing_numbers());
  replace_all(text, "value=\"robot_arm.urdf\"", "value=\"" + homed_file() + "\"");
  Counting arm{text};
  arm.rig.bring_to(State::PreOperational, works_by_position);
  arm.fly(5);
  const auto safe = arm.rig.set_state(State::SafeOperational);
  arm.fly(5);
  ASSERT_EQ(arm.rig.outcome(safe), "1 3 7");
  EXPECT_THAT(arm.asked(arm.rig.send(17, 128, {}), 200), HasSubstr("8:"));
  const auto early = arm.rig.set_state(State::Operational);
  arm.fly(5);
  EXPECT_THAT(arm.rig.outcome(early), StartsWith("1 4:010a"));
  arm.knows.fill(true);
  arm.ahead.fill(0);
  arm.fly(5);
  EXPECT_EQ(arm.asked(arm.rig.send(17, 128, {}), 200), "1 3 7");
}

}  // namespace
}  // namespace hirosco
