// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "subsystems/robot_arm/testing/ball.hpp"
#include "subsystems/robot_arm/testing/flown.hpp"

/// An arm that is carried and goes wherever it is led because somebody asked for it (docs/adr/0219).
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using ::testing::StartsWith;

struct RobotArmFloats : ::testing::Test {
  static constexpr std::uint16_t contact = 1025, too_near = 1026;
  static constexpr std::uint16_t too_fast = 1023, too_strong = 1020, much_too_strong = 1021;
  Flown flown{6, std::string{folder} + "robot_arm.urdf"};
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});

  void SetUp() override {
    flown.plant.place(start);
    flown.operate();
  }
  JointVector place() const { return flown.plant.measured().position; }
  std::string asked(const char* function, const std::vector<double>& numbers = {}) {
    const auto request = flown.ask(function, numbers);
    flown.cycle(3);
    return flown.rig.outcome(request);
  }
  /// Goes on for so long; the largest change of a torque from cycle to cycle, of its joint's effort.
  double steepest_in(int cycles) {
    JointVector last = flown.commanded;
    double steepest = 0;
    for (int i = 0; i < cycles; ++i) {
      flown.cycle();
      for (Eigen::Index j = 0; j < 6; ++j)
        steepest = std::max(steepest, std::abs(flown.commanded[j] - last[j]) /
                                          flown.model.joints()[static_cast<std::size_t>(j)].limits.effort.value());
      last = flown.commanded;
    }
    return steepest;
  }
  robotics::Vector3 tool_at(const JointVector& posture) const {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    dynamics.update({.q = posture, .qd = JointVector::Zero(6)});
    return dynamics.frame_pose(flown.model.find_frame("tool").value()).position;
  }
  void comes_to_goal() {
    const auto motion = flown.move_j(goal);
    flown.finish(motion);
    EXPECT_EQ(flown.rig.outcome(motion), "1 3 5:0001 7");
  }
};

TEST_F(RobotArmFloats, BeginsAndEndsWithoutAStepAndIsCarriedMeanwhile) {
  flown.cycle(500);
  const auto floats = flown.ask("FLOAT", {});
  EXPECT_LT(steepest_in(200), 0.06);
  EXPECT_EQ(flown.rig.outcome(floats), "1 3 7");
  flown.cycle(2000);
  EXPECT_LT(flown.off(start), 0.01) << "nobody leads it";
  flown.outside[0] = 15;
  flown.cycle(600);
  EXPECT_GT(place()[0] - start[0], 0.1) << "it is led";
  EXPECT_EQ(flown.rig.events(contact), 0);
  flown.outside[0] = 0;
  flown.cycle(1500);
  const JointVector left = place();
  const auto holds = flown.rig.call("HOLD");
  EXPECT_LT(steepest_in(200), 0.06);
  EXPECT_EQ(flown.rig.outcome(holds), "1 3 7");
  flown.cycle(500);
  EXPECT_LT(flown.off(left), 0.02) << "it holds where it is";
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  EXPECT_LE(flown.largest_share, 1);
  comes_to_goal();
}

/// Held for too short a time to be learnt: the law that it is let go into has little of it, and the one that holds it again has nothing.
TEST_F(RobotArmFloats, GoesOverWithoutAStepWhereSomebodyPushesIt) {
  const double effort = flown.model.joints()[0].limits.effort.value();
  flown.outside[0] = 20;
  flown.cycle(300);
  ASSERT_LT(flown.commanded[0], -15) << "it is held";
  const auto floats = flown.ask("FLOAT", {});
  // In 50 cycles; at once it would be what was not learnt.
  EXPECT_LT(steepest_in(400), 0.02);
  EXPECT_EQ(flown.rig.outcome(floats), "1 3 7");
  EXPECT_GT(place()[0] - start[0], 0.05) << "it is led";
  EXPECT_LT(flown.commanded[0], -10) << "by its damper";
  const auto holds = flown.rig.call("HOLD");
  // Its setpoint brakes as hard as behind a contact, which is no more than that; at once it would be all of its damper's besides.
  EXPECT_LT(steepest_in(1000), 0.06);
  EXPECT_EQ(flown.rig.outcome(holds), "1 3 7");
  EXPECT_NEAR(flown.commanded[0], -20, 0.05 * effort) << "and it is held again";
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(RobotArmFloats, HasNoMotionAndNoPayloadUntilItIsToHoldOrIsHardAgain) {
  ASSERT_EQ(asked("FLOAT"), "1 3 7");
  EXPECT_EQ(asked("FLOAT"), "1 3 7") << "it does already";
  const auto motion = flown.move_j(goal);
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(motion), StartsWith("1 4:800c"));
  EXPECT_THAT(asked("TORQUE_J", {1, 0, 0, 0, 0, 0, 0.1}), StartsWith("1 4:800c"));
  EXPECT_THAT(asked("RETREAT", {0.1}), StartsWith("1 4:800c"));
  EXPECT_THAT(asked("SET_PAYLOAD", {1, 0, 0, 0}), StartsWith("1 4:800c"));
  ASSERT_EQ(asked("POSITION_CONTROL"), "1 3 7");
  flown.cycle(500);
  comes_to_goal();
}

TEST_F(RobotArmFloats, IsNotLetGoWhileItMovesOnItsWay) {
  const auto motion = flown.move_j(goal);
  flown.cycle(300);
  EXPECT_THAT(asked("FLOAT"), StartsWith("1 4:0108"));
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 5:0001 7");
}

/// Its setpoint rests, and it does not.
TEST_F(RobotArmFloats, IsNotLetGoWhileItsSpringsSwingIt) {
  ASSERT_EQ(asked("IMPEDANCE_J", {200, 200, 100, 20, 20, 20, 0.7}), "1 3 7");
  flown.outside[0] = 30;
  for (int i = 0; i < 500 && std::abs(flown.plant.measured().velocity[0]) < 0.2; ++i) flown.cycle();
  ASSERT_GE(std::abs(flown.plant.measured().velocity[0]), 0.2);
  EXPECT_THAT(asked("FLOAT"), StartsWith("1 4:0108"));
  flown.outside[0] = 0;
  flown.cycle(3000);
  EXPECT_EQ(asked("FLOAT"), "1 3 7");
}

TEST_F(RobotArmFloats, IsStoppedAndLeftToItsBrakesByStop) {
  ASSERT_EQ(asked("FLOAT"), "1 3 7");
  flown.outside[0] = 15;
  flown.cycle(300);
  const auto stop = flown.rig.call("STOP");
  flown.outside[0] = 0;
  flown.finish(stop);
  EXPECT_EQ(flown.rig.outcome(stop), "1 3 7");
  flown.cycle(5);
  EXPECT_EQ(flown.mode, DeviceMode::Off);
  EXPECT_THAT(asked("FLOAT"), StartsWith("1 4:8006"));
}

/// And floats no more when it is brought up again.
TEST_F(RobotArmFloats, WhoIsMeasuredTooFastIsHeldByItsBrakes) {
  ASSERT_EQ(asked("FLOAT"), "1 3 7");
  flown.told = flown.plant.measured();
  flown.told->velocity[0] = 1.15 * flown.model.joints()[0].limits.velocity.value();
  flown.cycle(4);
  EXPECT_NE(flown.rig.inhibited(), 0u);
  EXPECT_EQ(flown.rig.events(too_fast), 1);
  EXPECT_EQ(flown.mode, DeviceMode::Off);
  flown.told.reset();
  flown.cycle(5);
  flown.command(State::SafeOperational);
  flown.command(State::Operational);
  const JointVector there = place();
  flown.outside[0] = 15;
  flown.cycle(500);
  EXPECT_LT(flown.off(there), 0.01);
}

/// A damper takes what it can before the velocity, and the limit of torque or of speed has it then.
TEST_F(RobotArmFloats, WhoIsPushedHarderThanItsDrivesAreIsHeldByItsBrakes) {
  ASSERT_EQ(asked("FLOAT"), "1 3 7");
  flown.outside[0] = 2 * flown.model.joints()[0].limits.effort.value();
  for (int i = 0; i < 1000 && flown.rig.inhibited() == 0; ++i) flown.cycle();
  EXPECT_NE(flown.rig.inhibited(), 0u);
  EXPECT_GE(flown.rig.events(too_fast) + flown.rig.events(too_strong) + flown.rig.events(much_too_strong), 1);
  flown.cycle(5);
  EXPECT_EQ(flown.mode, DeviceMode::Off);
  EXPECT_LE(flown.largest_share, 1);
}

TEST_F(RobotArmFloats, StaysBeforeTheEndOfARangeHoweverLongItIsPushedThere) {
  ASSERT_EQ(asked("FLOAT"), "1 3 7");
  const auto& range = flown.model.joints()[0].limits;
  flown.outside[0] = 15;
  double farthest = -HUGE_VAL;
  for (int i = 0; i < 8000; ++i) {
    flown.cycle();
    farthest = std::max(farthest, place()[0]);
  }
  EXPECT_LT(farthest, range.upper.value());
  EXPECT_GT(farthest, range.upper.value() - 0.1) << "it was led there";
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(RobotArmFloats, StandsBeforeWhatItKeepsOutOfHoweverOftenItIsLetGoThere) {
  constexpr double ball_m = 0.05, limit_m = 0.02;
  JointVector ahead = start;
  ahead[0] += 0.7;
  const robotics::Vector3 ball = tool_at(ahead);
  robot_arm::testing::keep_out_ball(flown, ball);
  for (int told = 1; told <= 3; ++told) {
    ASSERT_EQ(asked("FLOAT"), "1 3 7") << told;
    flown.outside[0] = 15;
    for (int i = 0; i < 3000 && flown.rig.events(too_near) < told; ++i) flown.cycle();
    EXPECT_EQ(flown.rig.events(too_near), told);
    flown.cycle(300);
    EXPECT_GT((tool_at(place()) - ball).norm(), ball_m + limit_m) << told;
    // What it has learnt of who pushes it is gone before it is let go again.
    flown.outside[0] = 0;
    flown.cycle(5000);
  }
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// What the law of positions had learnt is carried on; what comes to it then has it drift, as slowly as dampers let it.
TEST_F(RobotArmFloats, CarriesALoadThatNobodyDeclaredAsFarAsItHadLearntIt) {
  flown.outside[1] = 20;
  flown.cycle(4000);
  const JointVector there = place();
  ASSERT_EQ(asked("FLOAT"), "1 3 7");
  flown.cycle(1000);
  EXPECT_LT(flown.off(there), 0.02);
  flown.outside[1] += 10;
  flown.cycle(1000);
  EXPECT_GT(flown.off(there), 0.05);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST(RobotArmWithoutFloat, DoesNotFloatWhereItsDescriptorDoesNotOfferIt) {
  std::string text = robot_arm::testing::descriptor_for(6, std::string{folder} + "robot_arm.urdf");
  const auto from = text.find("<Function name=\"FLOAT\"");
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
