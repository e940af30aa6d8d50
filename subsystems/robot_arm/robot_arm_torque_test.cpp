// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "subsystems/robot_arm/testing/flown.hpp"

/// An arm that is driven by torques, for as long as somebody says so.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct RobotArmDriven : ::testing::Test {
  Flown flown{6, std::string{folder} + "robot_arm.urdf"};
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});

  void SetUp() override {
    flown.plant.place(start);
    flown.operate();
  }
  testing::Sent drive(std::size_t joint, double torque, double seconds) {
    std::vector<double> numbers(7, 0.0);
    numbers[joint] = torque;
    numbers[6] = seconds;
    return flown.ask("TORQUE_J", numbers);
  }
  std::string asked(const char* function, const std::vector<double>& numbers) {
    const auto request = flown.ask(function, numbers);
    flown.cycle(3);
    return flown.rig.outcome(request);
  }
  JointVector place() const { return flown.plant.measured().position; }
  double speed(Eigen::Index joint) const { return flown.plant.measured().velocity[joint]; }
  void stands() {
    const JointVector there = place();
    flown.cycle(500);
    EXPECT_LT(flown.off(there), 2e-3);
    EXPECT_EQ(flown.rig.inhibited(), 0u);
  }
};

TEST_F(RobotArmDriven, GoesWithItsTorqueAndStandsWithoutAJumpWhenNobodySaysMore) {
  flown.cycle(200);
  double steepest = 0;
  JointVector last = flown.commanded;
  const auto cycle = [&] {
    flown.cycle();
    for (Eigen::Index j = 0; j < 6; ++j)
      steepest = std::max(steepest, std::abs(flown.commanded[j] - last[j]) /
                                        flown.model.joints()[static_cast<std::size_t>(j)].limits.effort.value());
    last = flown.commanded;
  };
  const auto request = drive(0, 8, 0.5);
  for (int i = 0; i < 450; ++i) cycle();
  EXPECT_EQ(flown.rig.outcome(request), "1 3");
  EXPECT_GT(speed(0), 0.2);
  for (int i = 0; i < 1500; ++i) cycle();
  EXPECT_EQ(flown.rig.outcome(request), "1 3 7");
  EXPECT_LT(steepest, 0.06);
  EXPECT_GT(place()[0] - start[0], 0.1);
  stands();
  const auto motion = flown.move_j(start);
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 5:0001 7");
}

TEST_F(RobotArmDriven, GoesOnWhileItIsSaidAnewAndMovesByNothingElseMeanwhile) {
  auto request = drive(0, 4, 0.3);
  flown.cycle(200);
  double slowest = HUGE_VAL;
  for (int i = 0; i < 8; ++i) {
    const auto next = drive(0, 4, 0.3);
    for (int j = 0; j < 150; ++j) {
      flown.cycle();
      slowest = std::min(slowest, speed(0));
    }
    EXPECT_EQ(flown.rig.outcome(request), "1 3 7");
    EXPECT_EQ(flown.rig.outcome(next), "1 3");
    request = next;
  }
  EXPECT_GT(slowest, 0.02);
  const auto refused = flown.move_j(goal);
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(refused), StartsWith("1 4:0108"));
  flown.cycle(1500);
  EXPECT_EQ(flown.rig.outcome(request), "1 3 7");
  stands();
}

TEST_F(RobotArmDriven, IsDrivenNoLongerThanASecondAtAWord) {
  const auto* declared = flown.rig.descriptor().find_function("TORQUE_J");
  EXPECT_TRUE(pus::encode_call(*declared, std::vector{0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0}));
  EXPECT_FALSE(pus::encode_call(*declared, std::vector{0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.01}));
}

TEST_F(RobotArmDriven, HoldAndStopEndIt) {
  const auto held = drive(0, 8, 1);
  flown.cycle(300);
  EXPECT_EQ(asked("HOLD", {}), "1 3 7");
  EXPECT_EQ(flown.rig.outcome(held), "1 3 8:0204");
  flown.cycle(1000);
  stands();
  const auto stopped = drive(0, 8, 1);
  flown.cycle(300);
  const auto stop = flown.rig.call("STOP");
  flown.finish(stop);
  EXPECT_EQ(flown.rig.outcome(stop), "1 3 7");
  EXPECT_EQ(flown.rig.outcome(stopped), "1 3 8:0204");
  flown.cycle(5);
  EXPECT_EQ(flown.mode, DeviceMode::Off);
}

/// It presses against what does not move: what is measured stands, and the law of before asks for nothing by itself. What it pressed with goes as it goes for who is let go of, and
/// not within the third of a second of any other change.
TEST_F(RobotArmDriven, PressesNobodyLongerThanItTakesToLetGoOfHimOnceItIsOver) {
  const auto press = [&](int cycles) {
    for (int i = 0; i < cycles; ++i) {
      flown.plant.place(start);
      flown.cycle();
    }
  };
  flown.cycle(200);
  flown.told = flown.plant.measured();
  flown.told->velocity.setZero();
  for (const bool soft : {false, true}) {
    if (soft) {
      ASSERT_EQ(asked("IMPEDANCE_J", {200, 200, 100, 20, 20, 20, 0.7}), "1 3 7");
      press(400);
    }
    const auto request = drive(0, 20, 1);
    press(400);
    ASSERT_GT(flown.commanded[0], 18) << soft;
    ASSERT_EQ(asked("HOLD", {}), "1 3 7");
    EXPECT_EQ(flown.rig.outcome(request), "1 3 8:0204");
    press(60);
    EXPECT_LT(std::abs(flown.commanded[0]), 0.5) << soft;
    press(400);
  }
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(RobotArmDriven, IsNotDrivenThroughTheEndOfARangeHoweverLongItIsPushed) {
  const auto& limits = flown.model.joints()[5].limits;
  for (const double side : {1.0, -1.0}) {
    double farthest = 0;
    for (int i = 0; i < 10; ++i) {
      drive(5, side * 10, 1);
      for (int j = 0; j < 500; ++j) {
        flown.cycle();
        farthest = std::max(farthest, side * place()[5]);
      }
    }
    EXPECT_GT(farthest, *limits.upper - 0.1) << side;
    EXPECT_LE(farthest, *limits.upper) << side;
    ASSERT_EQ(flown.rig.inhibited(), 0u) << side;
  }
  flown.cycle(1500);
  stands();
}

TEST_F(RobotArmDriven, IsRefusedATorqueThatItsLimitWouldStopAndNamesTheJoint) {
  EXPECT_THAT(asked("TORQUE_J", {0, -110, 0, 0, 0, 0, 0.5}), StartsWith("1 4:8005"));
  flown.cycle(200);
  EXPECT_LT(flown.off(start), 1e-3);
}

/// A volume stands on its way; each push ends before it, and in the end none begins.
TEST_F(RobotArmDriven, StandsBeforeWhatItIsToKeepOutOfAndIsNotPushedIntoItBitByBit) {
  robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
  const auto tool_at = [&](const JointVector& q) {
    dynamics.update({.q = q, .qd = JointVector::Zero(6)});
    return dynamics.frame_pose(flown.model.find_frame("tool").value()).position;
  };
  JointVector there = start;
  there[0] += 0.8;
  const robotics::Vector3 kept_out = tool_at(there);
  std::vector<double> numbers{kept_out.x(), kept_out.y(), kept_out.z(), kept_out.x(), kept_out.y(), kept_out.z(), 0.05};
  numbers.resize(28, 0.0);
  ASSERT_EQ(asked("KEEP_OUT", numbers), "1 3 7");
  const auto first = drive(0, 6, 1);
  double nearest = HUGE_VAL;
  const auto go_on = [&] {
    for (int i = 0; i < 1500; ++i) {
      flown.cycle();
      nearest = std::min(nearest, (tool_at(place()) - kept_out).norm());
    }
  };
  go_on();
  EXPECT_THAT(flown.rig.outcome(first), HasSubstr("8:800a"));
  EXPECT_EQ(flown.rig.events(1026), 1);
  bool refused = false;
  for (int i = 0; i < 30 && !refused; ++i) {
    const auto next = drive(0, 6, 1);
    go_on();
    refused = flown.rig.outcome(next).starts_with("1 4:800a");
  }
  EXPECT_TRUE(refused);
  EXPECT_GT(nearest, 0.05);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  const auto away = drive(0, -6, 0.5);
  flown.cycle(400);
  EXPECT_EQ(flown.rig.outcome(away), "1 3");
  EXPECT_LT(speed(0), -0.05);
}

TEST_F(RobotArmDriven, StandsWhereItMeetsSomebody) {
  const auto request = drive(0, 6, 1);
  flown.cycle(400);
  ASSERT_EQ(flown.rig.events(1025), 0);
  flown.outside[0] = -60;
  for (int i = 0; i < 100 && flown.rig.events(1025) == 0; ++i) flown.cycle();
  flown.cycle();
  EXPECT_EQ(flown.rig.outcome(request), "1 3 8:8004");
  flown.cycle(500);
  EXPECT_EQ(flown.rig.events(1025), 1);
  flown.outside[0] = 0;
  flown.cycle(1500);
  stands();
}

TEST_F(RobotArmDriven, WhoWasSoftIsSoftAgainBehindIt) {
  ASSERT_EQ(asked("SET_CONTACT", {0, 0.3}), "1 3 7");
  ASSERT_EQ(asked("IMPEDANCE_J", {200, 200, 100, 20, 20, 20, 0.7}), "1 3 7");
  const auto request = drive(0, 6, 0.4);
  flown.cycle(1500);
  EXPECT_EQ(flown.rig.outcome(request), "1 3 7");
  const JointVector there = place();
  flown.outside[0] = 30;
  flown.cycle(1500);
  EXPECT_GT(flown.off(there), 0.1);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// What the descriptor leaves out, the arm does not have.
TEST(RobotArmWithoutTorque, IsNotDrivenWhereItsDescriptorDoesNotOfferIt) {
  std::string text = robot_arm::testing::descriptor_for(6, std::string{folder} + "robot_arm.urdf");
  const auto from = text.find("<Function name=\"TORQUE_J\"");
  ASSERT_NE(from, std::string::npos);
  const std::string end = "</Function>";
  text.erase(from, text.find(end, from) + end.size() - from);
  const auto arm = make_robot_arm();
  testing::Rig rig{*arm, text};
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7") << ::testing::PrintToString(rig.explanations);
  EXPECT_EQ(rig.configure_now(1), "1 3 7");
}

}  // namespace
}  // namespace hirosco
