// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/floating/floating_laws.hpp"
#include "subsystems/robot_arm/testing/free_plant.hpp"

/// With which force a floating arm presses, and how much work it does (docs/adr/0235): on a craft that nothing holds.
namespace hirosco {
namespace {

using robot_arm::FloatingLaws;
using robot_arm::FloatingModel;
using robot_arm::JointVector;
using robot_arm::LawKind;
using robot_arm::vector_of;
using ::testing::StartsWith;

constexpr double limit_n = 20, commanded_n = 18;

/// Torques of one law in a posture in which somebody holds the joints fast: all of it presses.
struct FloatingPress : ::testing::Test {
  robotics::Model model = robot_arm::testing::model_of(robot_arm::testing::floating_folder + "floating_arm.urdf");
  std::vector<robot_arm::JointBounds> bounds = robot_arm::testing::bounds_of(model);
  FloatingModel known{model, model.find_frame("tool").value()};
  JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});
  robot_arm::ToolLever lever;
  FloatingLaws laws;

  FloatingPress() {
    EXPECT_TRUE(known.update({}, ready));
    lever.update(robot_arm::ToolLever::Rows{known.tool_of_free().bottomRows<3>()});
    laws.begin(7, 0.001);
  }
  [[nodiscard]] FloatingLaws::Now wanted(LawKind kind) const {
    FloatingLaws::Now now;
    now.kind = kind;
    now.rates = vector_of(std::array{0.2, -0.2, 0.1, 0.2, 0.0, 0.1, 0.0});
    now.goal.joints = {ready + 0.5 * JointVector::Ones(7), JointVector::Zero(7), JointVector::Zero(7)};
    now.goal.tool.pose = known.tool();
    now.goal.tool.pose.position += robotics::Vector3{0.2, 0.1, -0.2};
    now.driven = {vector_of(std::array{20.0, -30.0, 20.0, 20.0, 1.0, 5.0, 0.0}), JointVector::Zero(7)};
    return now;
  }
  /// N at the tool after a second, which all that fades needs.
  [[nodiscard]] double pressed(FloatingLaws::Now now, double limit) {
    laws.set({.joint_n_m_rad = 100 * JointVector::Ones(7), .tool_n_m = 1000, .tool_n_m_rad = 50});
    now.lever = &lever;
    now.work.force_n = limit;
    const robot_arm::Measured held{ready, JointVector::Zero(7), JointVector::Zero(7)};
    JointVector torque;
    for (int i = 0; i < 1000; ++i) torque = laws.torque(known, held, bounds, now);
    return lever.force(torque).norm();
  }
};

TEST_F(FloatingPress, IsNoHarderThanItMayBeInEachLaw) {
  for (const LawKind kind : {LawKind::Position, LawKind::JointImpedance, LawKind::ToolImpedance, LawKind::Torque}) {
    EXPECT_GT(pressed(wanted(kind), HUGE_VAL), 1.5 * limit_n) << static_cast<int>(kind) << ": else it says nothing";
    EXPECT_LE(pressed(wanted(kind), limit_n), commanded_n * (1 + 1e-6)) << static_cast<int>(kind);
    EXPECT_GT(pressed(wanted(kind), limit_n), 0.99 * commanded_n) << static_cast<int>(kind);
  }
}

/// Somebody lets joints go with this velocity, and no faster.
TEST_F(FloatingPress, GivesNoMorePowerThanItMay) {
  FloatingLaws::Now now = wanted(LawKind::Torque);
  now.lever = &lever;
  now.driven.torque = vector_of(std::array{60.0, 0.0, 0.0, -60.0, 0.0, 0.0, 0.0});
  const robot_arm::Measured led{ready, vector_of(std::array{0.15, 0.0, 0.0, -0.15, 0.0, 0.0, 0.0}),
                                JointVector::Zero(7)};
  const auto power = [&] {
    JointVector torque;
    for (int i = 0; i < 1000; ++i) torque = laws.torque(known, led, bounds, now);
    return torque.cwiseProduct(led.velocity).cwiseMax(0).sum();
  };
  EXPECT_GT(power(), 15);
  now.work.power_w = 10;
  EXPECT_NEAR(power(), 9, 1e-6);
}

/// What accelerates an arm that nobody meets is no pressing: a stop is as hard under the least limit as under none.
TEST(FloatingStop, IsAsHardAsItWouldBeWithoutALimit) {
  const robotics::Model model = robot_arm::testing::model_of(robot_arm::testing::floating_folder + "floating_arm.urdf");
  const auto bounds = robot_arm::testing::bounds_of(model);
  const JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});
  const JointVector fast = vector_of(std::array{0.2, -0.2, 0.0, 0.2, 0.0, 0.0, 0.0});
  std::array<JointVector, 2> ends;
  double hardest_n = 0;
  for (const bool limited : {false, true}) {
    robot_arm::testing::FreePlant plant{model};
    FloatingModel known{model, model.find_frame("tool").value()};
    FloatingLaws laws;
    laws.begin(7, 0.001);
    plant.place(ready);
    for (int i = 0; i < 2500; ++i) {
      ASSERT_TRUE(known.update(plant.base(), plant.measured().position));
      robot_arm::ToolLever lever;
      lever.update(robot_arm::ToolLever::Rows{known.tool_of_free().bottomRows<3>()});
      FloatingLaws::Now now;
      now.rates = std::clamp(i < 1000 ? i / 200.0 : (1200 - i) / 200.0, 0.0, 1.0) * fast;
      now.lever = &lever;
      if (limited) now.work = {.force_n = 10, .power_w = 10, .tool_power_w = 1};
      const JointVector torque = laws.torque(known, plant.measured(), bounds, now);
      if (limited) hardest_n = std::max(hardest_n, lever.force(torque).norm());
      plant.step(torque, 0.001);
    }
    ends.at(limited) = plant.measured().position;
  }
  EXPECT_GT(hardest_n, 12) << "else the limit would not have mattered";
  EXPECT_LT((ends[1] - ends[0]).cwiseAbs().maxCoeff(), 5e-3);
}

struct FloatingArmWorks : robot_arm::testing::FreeArm {
  static constexpr std::uint16_t force_exceeded = 2120, power_exceeded = 2121, tool_power_exceeded = 2122;
  void expect_nothing_exceeded() {
    for (const auto event : {force_exceeded, power_exceeded, tool_power_exceeded})
      EXPECT_EQ(flown.rig.events(event), 0) << event;
    EXPECT_EQ(flown.rig.inhibited(), 0u);
  }
};

TEST_F(FloatingArmWorks, OnItsOwnWaysWithinTheLeastLimits) {
  begin();
  ASSERT_EQ(asked("SET_FORCE_LIMIT", {10}), done);
  ASSERT_EQ(asked("SET_POWER_LIMIT", {10, 1}), done);
  EXPECT_EQ(asked("MOVE_TOOL", {0.1, 0.05, -0.05, 6}), done);
  EXPECT_EQ(asked("JOG_L", {0.05, 0, 0, 0, 0, 0, 1}), done);
  EXPECT_EQ(asked("JOG_J", {0.1, 0, 0, -0.1, 0, 0, 0, 1}), done);
  EXPECT_EQ(asked("RETREAT", {0.2}), done);
  expect_nothing_exceeded();
}

/// Pushed at the tool, which a craft that nothing holds feels as that.
TEST_F(FloatingArmWorks, TellsWithWhichForceItIsPushed) {
  begin();
  ASSERT_NO_FATAL_FAILURE(react_by(0));
  flown.plant.push_n = {0, 0, 8};
  flown.cycle(300);
  EXPECT_NEAR(flown.told_number("TOOL_FORCE"), 8, 0.8) << "the last of the three is along z";
}

TEST_F(FloatingArmWorks, IsStoppedBeyondTheForceThatItMayPressWith) {
  begin();
  ASSERT_NO_FATAL_FAILURE(react_by(0));
  ASSERT_EQ(asked("SET_FORCE_LIMIT", {10}), done);
  flown.plant.push_n = {-8, 0, 0};
  flown.cycle(300);
  expect_nothing_exceeded();
  const auto motion = ask("MOVE_TOOL", {0.05, 0, 0, 6});
  flown.plant.push_n = {-14, 0, 0};
  flown.cycle(300);
  EXPECT_EQ(flown.rig.events(force_exceeded), 1);
  EXPECT_THAT(flown.rig.outcome(motion), StartsWith("1 3 8:8003")) << "LIMIT_TRIPPED";
  EXPECT_NE(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmWorks, TakesNoLimitThatIsExceededAlready) {
  begin();
  ASSERT_NO_FATAL_FAILURE(react_by(0));
  flown.plant.push_n = {-14, 0, 0};
  flown.cycle(300);
  EXPECT_THAT(asked("SET_FORCE_LIMIT", {10}), StartsWith("1 4:800e"));
  EXPECT_EQ(asked("SET_FORCE_LIMIT", {30}), done);
}

TEST_F(FloatingArmWorks, RefusesAWayOfJointsThatWouldTakeMorePower) {
  begin();
  ASSERT_EQ(asked("SET_POWER_LIMIT", {10, 5}), done);
  const JointVector goal = ready + vector_of(std::array{0.6, 0.0, 0.6, 0.6, 0.6, 0.0, 0.6});
  const auto go = [&](double seconds) {
    return ask("MOVE_JOINT", {goal[0], goal[1], goal[2], goal[3], goal[4], goal[5], goal[6], seconds});
  };
  EXPECT_THAT(flown.rig.outcome(go(8)), StartsWith("1 4:8004")) << "TOO_FAST, W";
  const auto slower = go(30);
  flown.finish(slower, 60'000);
  EXPECT_EQ(flown.rig.outcome(slower), done);
  expect_nothing_exceeded();
}

}  // namespace
}  // namespace hirosco
