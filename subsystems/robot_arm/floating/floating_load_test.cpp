// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "robotics/dynamics/integrator.hpp"
#include "subsystems/robot_arm/floating/tool_law.hpp"
#include "subsystems/robot_arm/floating/tool_way.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// What a floating arm has at its tip, beside a robot whose file says so (docs/adr/0222).
namespace hirosco::robot_arm {
namespace {

const std::string servicer_file = HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/floating_arm.urdf";

/// With this at its tool, and a frame "other" there.
[[nodiscard]] robotics::Model servicer_with(const Payload& payload, const robotics::Pose& other = {}) {
  auto description = testing::described(servicer_file);
  const auto tool = std::ranges::find(description.frames, "tool", [](const auto& frame) { return frame.name; });
  auto& last = description.joints.at(tool->joint.value());
  last.moved =
      last.moved + robotics::Inertia{payload.mass_kg, tool->placement * payload.place_m, robotics::Matrix3::Zero()};
  auto frame = *tool;
  frame.name = "other";
  frame.placement = tool->placement * other;
  description.frames.push_back(frame);
  return robotics::Model::make(description).value();
}

struct FloatingLoad : ::testing::Test {
  robotics::Model model = servicer_with({});
  JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});
  robotics::Pose base{robotics::Quaternion{Eigen::AngleAxisd{0.7, Vector3{1, 2, 3}.normalized()}}.toRotationMatrix(),
                      {1, -2, 0.5}};
  Payload payload{20, {0.1, -0.05, 0.2}};

  [[nodiscard]] static FloatingModel at(const robotics::Model& robot, const char* tip, const robotics::Pose& base,
                                        const JointVector& position, const Payload& payload = {},
                                        const robotics::Pose& tool = {}) {
    FloatingModel its{robot, robot.find_frame(tip).value()};
    its.carry(tool, payload);
    EXPECT_TRUE(its.update(base, position));
    return its;
  }
};

TEST_F(FloatingLoad, IsAsInTheFileOfARobotThatHasIt) {
  const robotics::Model loaded = servicer_with(payload);
  const FloatingModel said = at(model, "tool", base, ready, payload), built = at(loaded, "tool", base, ready);
  EXPECT_LT((said.base() - built.base()).norm(), 1e-12);
  EXPECT_LT((said.inertia() - built.inertia()).norm(), 1e-10);
  EXPECT_LT((said.tool_of_free() - built.tool_of_free()).norm(), 1e-12);
  EXPECT_NEAR(said.conditioning(), built.conditioning(), 1e-12);
  EXPECT_GT((said.base() - at(model, "tool", base, ready).base()).norm(), 1e-2) << "the base gives way more";
}

/// What it takes without accelerating: else an arm that turns with a payload would feel somebody who is not there.
TEST_F(FloatingLoad, TakesWithoutAcceleratingWhatARobotThatHasItTakes) {
  const robotics::Model loaded = servicer_with(payload);
  FloatingModel said = at(model, "tool", base, ready, payload), built = at(loaded, "tool", base, ready);
  FloatingModel empty = at(model, "tool", base, ready);
  const JointVector velocity = vector_of(std::array{0.2, -0.1, 0.15, 0.2, -0.2, 0.2, 0.1});
  const JointVector its = built.bias(velocity);
  EXPECT_LT((said.bias(velocity) - its).norm(), 1e-10);
  EXPECT_GT((empty.bias(velocity) - its).norm(), 1e-2);
}

TEST_F(FloatingLoad, AToolIsMovedAsAFrameThereIs) {
  const robotics::Pose tool{Eigen::AngleAxisd{0.4, Vector3::UnitY()}.toRotationMatrix(), {0.1, 0.05, 0.3}};
  const robotics::Model other = servicer_with({}, tool);
  const FloatingModel said = at(model, "tool", base, ready, {}, tool), built = at(other, "other", base, ready);
  EXPECT_LT((said.tool().position - built.tool().position).norm(), 1e-12);
  EXPECT_LT((said.tool().rotation - built.tool().rotation).norm(), 1e-12);
  EXPECT_LT((said.tool_of_free() - built.tool_of_free()).norm(), 1e-12);
  EXPECT_LT((said.tool_of_fixed() - built.tool_of_fixed()).norm(), 1e-12);
  EXPECT_LT((said.base() - at(model, "tool", base, ready).base()).norm(), 1e-15) << "it weighs nothing";
}

/// Who is not there would be answered that many times too hard.
TEST_F(FloatingLoad, IsNeverMoreTimesWhatJointsMoveThanIsTold) {
  EXPECT_EQ(at(model, "tool", base, ready).heavier(), 1);
  for (const double bent : {1.85, 0.2, -1.0}) {
    JointVector posture = ready;
    posture[5] = bent;
    const FloatingModel empty = at(model, "tool", base, posture), loaded = at(model, "tool", base, posture, payload);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver{loaded.inertia(), empty.inertia()};
    const double most = solver.eigenvalues().maxCoeff();
    EXPECT_GE(loaded.heavier(), most * (1 - 1e-9)) << bent;
    EXPECT_LE(loaded.heavier(), 2 * most) << bent;
  }
}

TEST_F(FloatingLoad, IsFollowedNoFasterThanItIsStableWithoutIt) {
  EXPECT_EQ(followed_with(1, 0.001), followed_per_s);
  EXPECT_EQ(followed_with(1, 0.004), followed_per_s);
  EXPECT_EQ(followed_with(8, 0.001), followed_per_s);
  EXPECT_NEAR(followed_with(32, 0.001), 10, 1e-9);
  EXPECT_NEAR(followed_with(8, 0.004), 10, 1e-9);
}

TEST_F(FloatingLoad, WaysOfTheToolAreReckonedWithIt) {
  const robotics::Model loaded = servicer_with(payload);
  const FloatingModel begun = at(model, "tool", base, ready);
  const std::vector<JointBounds> bounds = testing::bounds_of(model);
  const auto end_of = [&](const robotics::Model& robot, const Payload& its) {
    ToolWay way{robot, robot.find_frame("tool").value()};
    way.carry({}, its);
    way.begin({.law = ToolLaw::InertialTrack,
               .base = base,
               .base_kept = base.rotation,
               .position = ready,
               .tool = begun.tool(),
               .offset_m = {0.2, 0, 0},
               .duration_s = 20});
    while (way.step(bounds)) {}
    return way.posture();
  };
  EXPECT_LT((end_of(model, payload) - end_of(loaded, {})).norm(), 1e-9);
  EXPECT_GT((end_of(model, payload) - end_of(model, {})).norm(), 1e-3);
}

/// 20 kg, 0.1 m beyond the tool, and a move of 0.1 m in 10 s: by a reckoning of this robot's kinematics without momentum 0.03 and 0.07 mm where it is said, 8.5 mm and 10.9 mm with 0.37 deg where it is not.
TEST_F(FloatingLoad, IsMadeUpForByWhoWasToldOfItAlone) {
  const Payload carried{20, {0, 0, 0.1}};
  const robotics::Model loaded = servicer_with(carried);
  const auto bounds = testing::bounds_of(model);
  for (const ToolLaw law : {ToolLaw::InertialTrack, ToolLaw::AttitudeHold}) {
    std::array<double, 2> off_m{}, turned{};
    for (const bool told : {false, true}) {
      FloatingModel its{model, model.find_frame("tool").value()};
      if (told) its.carry({}, carried);
      robotics::State state;
      state.q = ready;
      state.qd = JointVector::Zero(7);
      robotics::Dynamics dynamics{loaded, robotics::Base::Free};
      robotics::Integrator integrator{dynamics};
      struct Drives final : robotics::Integrator::Force {
        JointVector torque = JointVector::Zero(7);
        void at(double, robotics::Coordinates& force) const noexcept override { force.tail(7) = torque; }
      } drives;
      constexpr double cycle_s = 2e-3, duration_s = 10;
      robotics::Pose begun;
      for (int i = 0; i < 5000; ++i) {
        const double t = i * cycle_s;
        const robotics::Matrix3 attitude = state.base_orientation.toRotationMatrix();
        ASSERT_TRUE(its.update({attitude, state.base_position}, state.q));
        if (i == 0) begun = its.tool();
        const Course at = course(t, duration_s);
        ToolGoal goal{begun, {0.1 * at.per_s, 0, 0}};
        goal.pose.position.x() += 0.1 * at.share;
        off_m[told] = std::max(off_m[told], (goal.pose.position - its.tool().position).norm());
        turned[told] = std::max(turned[told], rotation_between(attitude, robotics::Matrix3::Identity()).norm());
        JointVector rates = tool_rates(law, its, bounds, goal, attitude, robotics::Matrix3::Identity());
        slow_down(rates, bounds);
        drives.torque = joint_torque(its, rates, state.qd, bounds, followed_with(its.heavier(), 1e-3));
        ASSERT_TRUE(integrator.step(state, t, cycle_s, drives));
      }
    }
    EXPECT_LT(off_m[true], 0.5e-3) << "said";
    EXPECT_GT(off_m[false], 4e-3) << "not said";
    if (law == ToolLaw::AttitudeHold) {
      EXPECT_LT(turned[true], 1e-4);
      EXPECT_GT(turned[false], 2e-3);
    }
  }
}

/// A goal that turns is followed as it turns, and not behind.
TEST_F(FloatingLoad, AToolTurnsAsFastAsItIsTold) {
  const FloatingModel its = at(model, "tool", {}, ready);
  const robotics::Matrix3 upright = robotics::Matrix3::Identity();
  const std::vector<JointBounds> bounds = testing::bounds_of(model);
  ToolGoal goal{its.tool(), Vector3::Zero()};
  goal.turning_rad_s = {0.01, -0.02, 0.015};
  const Vector6 twist = its.tool_of_free() * tool_rates(ToolLaw::InertialTrack, its, bounds, goal, upright, upright);
  EXPECT_NEAR((twist.head<3>() - goal.turning_rad_s).norm(), 0, 1e-5);
  EXPECT_NEAR(twist.tail<3>().norm(), 0, 1e-5);
}

}  // namespace
}  // namespace hirosco::robot_arm
