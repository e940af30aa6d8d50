// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/tool_law.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "robotics/dynamics/integrator.hpp"
#include "subsystems/robot_arm/floating/base_estimate.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// Figures of the servicer come from the design of its scenarios, not from here.
namespace hirosco::robot_arm {
namespace {

const robotics::Model& servicer() {
  static const robotics::Model model =
      testing::model_of(HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/floating_arm.urdf");
  return model;
}
[[nodiscard]] JointVector joints(std::initializer_list<double> numbers) {
  JointVector vector(static_cast<Eigen::Index>(numbers.size()));
  std::ranges::copy(numbers, vector.begin());
  return vector;
}
const JointVector stow = joints({0, -1.2, 0, 2.4, 0, -1.2, 0});
const JointVector ready = joints({0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0});
const JointVector stretched = joints({0.3, 0.35, 0.2, 1.1, -0.3, 0.5, 0.1});

[[nodiscard]] FloatingModel model_at(const JointVector& q, const robotics::Pose& base = {}) {
  FloatingModel model{servicer(), servicer().find_frame("tool").value()};
  EXPECT_TRUE(model.update(base, q));
  return model;
}

[[nodiscard]] Bounds bounds() {
  static const std::vector<JointBounds> all = testing::bounds_of(servicer());
  return all;
}

TEST(BaseEstimate, IsAMeanFromItsFirstSamplesOnAndKeepsASixthOfTheNoise) {
  std::mt19937 random{7};
  std::normal_distribution<double> noise_m{0, 1e-3};
  BaseEstimate base;
  const robotics::Vector3 place{1, 2, 3};
  const robotics::Quaternion turned{std::cos(0.1), std::sin(0.1), 0, 0};
  base.take(place, turned);
  EXPECT_EQ(base.position_m(), place) << "the first as it is";
  EXPECT_NEAR(base.orientation().angularDistance(turned), 0, 1e-12);
  double square = 0;
  constexpr int count = 4000;
  for (int i = 0; i < count; ++i) {
    base.take(place + robotics::Vector3{noise_m(random), noise_m(random), noise_m(random)}, turned);
    if (i >= 100) square += (base.position_m() - place).squaredNorm() / 3 / (count - 100);
  }
  EXPECT_NEAR(std::sqrt(square), 1e-3 / std::sqrt(2.0 * BaseEstimate::most_samples - 1), 0.2e-4);
  base.forget();
  base.take({0, 0, 0}, turned);
  EXPECT_EQ(base.position_m(), robotics::Vector3::Zero()) << "after a silence, too";
}

TEST(BaseEstimate, PassesOverSamplesThatAreNoPlaceOrNoAttitude) {
  BaseEstimate base;
  const robotics::Quaternion turned{std::cos(0.1), std::sin(0.1), 0, 0};
  base.take({1, 2, 3}, turned);
  const double none = std::numeric_limits<double>::quiet_NaN(), endless = std::numeric_limits<double>::infinity();
  for (const double bad : {none, endless, -endless}) {
    base.take({1, bad, 3}, turned);
    base.take({5, 5, 5}, {1, bad, 0, 0});
  }
  base.take({5, 5, 5}, {0, 0, 0, 0});
  EXPECT_EQ(base.position_m(), robotics::Vector3(1, 2, 3));
  EXPECT_NEAR(base.orientation().angularDistance(turned), 0, 1e-9);
  base.take({2, 2, 3}, turned);
  EXPECT_EQ(base.position_m(), robotics::Vector3(1.5, 2, 3)) << "the second sample: those between do not count";
}

TEST(BaseEstimate, GoesOnBetweenSamplesAsTheBaseMovesByItself) {
  BaseEstimate base;
  robotics::Vector6 twist = robotics::Vector6::Zero();
  twist[2] = 0.5;  // rad/s about z
  twist[3] = 1;    // m/s along its own x: a circle with a radius of 2 m
  for (int i = 0; i < 1000; ++i) base.go_on(twist, 1e-3);
  EXPECT_NEAR(base.position_m().x(), 2 * std::sin(0.5), 1e-3);
  EXPECT_NEAR(base.position_m().y(), 2 * (1 - std::cos(0.5)), 1e-3);
  EXPECT_NEAR(base.orientation().angularDistance(robotics::Quaternion::Identity()), 0.5, 1e-6);
}

TEST(FloatingModel, KnowsTheServicersToolAndHowWellItCanHoldItsAttitude) {
  const FloatingModel model = model_at(ready);
  EXPECT_NEAR((model.tool().position - Vector3{1.10682, 0.26227, 2.60166}).norm(), 0, 1e-5);
  // The design tells three digits; by an independent reckoning the second is 0.0855.
  EXPECT_NEAR(model.conditioning(), 0.200, 1e-3);
  EXPECT_NEAR(model_at(stow).conditioning(), 0.086, 1e-3);
  EXPECT_NEAR(model_at(stretched).conditioning(), 0.014, 1e-3);
}

/// Momentum is nothing before, so it is nothing afterwards: base and tool move as the two matrices say.
TEST(FloatingModel, SaysHowBaseAndToolMoveWithoutMomentum) {
  const robotics::Pose base{
      robotics::Quaternion{Eigen::AngleAxisd{0.7, Vector3{1, 2, 3}.normalized()}}.toRotationMatrix(), {1, -2, 0.5}};
  FloatingModel model = model_at(ready, base);
  robotics::State state;
  state.base_position = base.position;
  state.base_orientation = robotics::Quaternion{base.rotation};
  state.q = ready;
  state.qd = joints({0.1, -0.05, 0.08, 0.12, -0.1, 0.04, 0.15});
  state.base_twist = model.base() * state.qd;
  robotics::Dynamics dynamics{servicer(), robotics::Base::Free};
  dynamics.update(state);
  EXPECT_NEAR(dynamics.momentum().linear.norm(), 0, 1e-12);
  EXPECT_NEAR(dynamics.momentum().angular.norm(), 0, 1e-12);
  const auto tool = servicer().find_frame("tool").value();
  EXPECT_NEAR((dynamics.frame_twist(tool) - model.tool_of_free() * state.qd).norm(), 0, 1e-13);
  robotics::Jacobian other;
  ASSERT_TRUE(dynamics.generalised_jacobian(tool, other));
  EXPECT_NEAR((other - model.tool_of_free()).norm(), 0, 1e-12);
}

/// Energy of a robot without momentum is that of its joints alone.
TEST(FloatingModel, HasTheInertiaThatTheJointsFeel) {
  FloatingModel model = model_at(ready);
  robotics::State state;
  state.q = ready;
  state.qd = joints({0.1, -0.05, 0.08, 0.12, -0.1, 0.04, 0.15});
  state.base_twist = model.base() * state.qd;
  robotics::Dynamics dynamics{servicer(), robotics::Base::Free};
  dynamics.update(state);
  EXPECT_NEAR(dynamics.kinetic_energy(), 0.5 * state.qd.dot(model.inertia() * state.qd), 1e-13);
}

TEST(ToolLaw, InertialTrackGoesToItsGoalWhateverTheBaseDoes) {
  const FloatingModel model = model_at(ready);
  ToolGoal goal{model.tool(), {0.01, -0.02, 0.005}};
  const robotics::Matrix3 upright = robotics::Matrix3::Identity();
  const JointVector rates = tool_rates(ToolLaw::InertialTrack, model, bounds(), goal, upright, upright);
  const Vector6 twist = model.tool_of_free() * rates;
  EXPECT_NEAR((twist.tail<3>() - goal.velocity_m_s).norm(), 0, 1e-5);
  EXPECT_NEAR(twist.head<3>().norm(), 0, 1e-5);
  EXPECT_GT((model.base().topRows<3>() * rates).norm(), 1e-4);
}

TEST(ToolLaw, AttitudeHoldMovesTheToolAndTurnsTheBaseBack) {
  const FloatingModel model = model_at(ready);
  ToolGoal goal{model.tool(), {0.01, -0.02, 0.005}};
  const robotics::Matrix3 upright = robotics::Matrix3::Identity();
  JointVector rates = tool_rates(ToolLaw::AttitudeHold, model, bounds(), goal, upright, upright);
  EXPECT_NEAR(((model.tool_of_free() * rates).tail<3>() - goal.velocity_m_s).norm(), 0, 1e-5);
  EXPECT_NEAR((model.base().topRows<3>() * rates).norm(), 0, 1e-7);
  // Off by 1 mrad about x it turns back with half of that in a second.
  const robotics::Matrix3 off = Eigen::AngleAxisd{1e-3, Vector3::UnitX()}.toRotationMatrix();
  goal.velocity_m_s.setZero();
  rates = tool_rates(ToolLaw::AttitudeHold, model, bounds(), goal, off, upright);
  EXPECT_NEAR((model.base().topRows<3>() * rates - Vector3{-5e-4, 0, 0}).norm(), 0, 1e-7);
}

TEST(ToolLaw, SlowsDownAllJointsTogetherAndStopsAtWhatIsNoNumber) {
  const auto bounds = testing::bounds_of(servicer());
  JointVector rates = joints({0.1, -0.4, 0, 0, 0, 0, 0.2});
  slow_down(rates, bounds);
  EXPECT_NEAR((rates - joints({0.05, -0.2, 0, 0, 0, 0, 0.1})).norm(), 0, 1e-15);
  rates[3] = NAN;
  slow_down(rates, bounds);
  EXPECT_EQ(rates, JointVector::Zero(7));
}

TEST(ToolLaw, TorquesAreHeldToTheEfforts) {
  const auto bounds = testing::bounds_of(servicer());
  const JointVector torque = joint_torque(model_at(ready), JointVector::Constant(7, 5), JointVector::Zero(7), bounds);
  EXPECT_EQ(torque.cwiseAbs().maxCoeff(), 80);
}

TEST(Course, GoesFromRestToRest) {
  EXPECT_EQ(course(0, 20).share, 0);
  EXPECT_EQ(course(0, 20).per_s, 0);
  EXPECT_NEAR(course(10, 20).share, 0.5, 1e-15);
  EXPECT_NEAR(course(10, 20).per_s, fastest_of_course / 20, 1e-15);
  EXPECT_EQ(course(20, 20).share, 1);
  EXPECT_EQ(course(25, 20).per_s, 0);
  // Never behind its beginning or beyond its end: joints whose goal is in range stay there on the way.
  for (double t = 0; t < 25; t += 0.25) {
    EXPECT_LE(course(t, 20).share, course(t + 0.25, 20).share);
    EXPECT_TRUE(course(t, 20).share >= 0 && course(t, 20).share <= 1);
  }
  for (double t = 0.5; t < 20; t += 0.5)
    EXPECT_NEAR(course(t, 20).per_s, (course(t + 1e-5, 20).share - course(t - 1e-5, 20).share) / 2e-5, 1e-8);
}

/// Both laws on the on-board model itself: 0.2 m along x in 20 s, without sensors between.
TEST(ToolLaw, KeepsTheFiguresOfTheDesignOnItsOwnModel) {
  struct Case {
    ToolLaw law;
    double most_error_m, most_turn_deg;
  };
  for (const Case& each : {Case{ToolLaw::InertialTrack, 0.08e-3, 3.9}, Case{ToolLaw::AttitudeHold, 0.08e-3, 5e-5}}) {
    FloatingModel model = model_at(ready);
    const robotics::Pose begun = model.tool();
    robotics::State state;
    state.q = ready;
    state.qd = JointVector::Zero(7);
    robotics::Dynamics dynamics{servicer(), robotics::Base::Free};
    robotics::Integrator integrator{dynamics};
    struct Drives final : robotics::Integrator::Force {
      JointVector torque = JointVector::Zero(7);
      void at(double, robotics::Coordinates& force) const noexcept override { force.tail(7) = torque; }
    } drives;
    const auto bounds = testing::bounds_of(servicer());
    double most_error_m = 0, most_turn_deg = 0;
    constexpr double cycle_s = 2e-3;
    for (int i = 0; i < 10'000; ++i) {
      const double t = i * cycle_s;
      const robotics::Pose base{state.base_orientation.toRotationMatrix(), state.base_position};
      ASSERT_TRUE(model.update(base, state.q));
      const Course at = course(t, 20);
      ToolGoal goal{begun, {0.2 * at.per_s, 0, 0}};
      goal.pose.position.x() += 0.2 * at.share;
      most_error_m = std::max(most_error_m, (goal.pose.position - model.tool().position).norm());
      most_turn_deg = std::max(most_turn_deg, rotation_between(base.rotation, robotics::Matrix3::Identity()).norm() *
                                                  180 / std::numbers::pi);
      JointVector rates = tool_rates(each.law, model, bounds, goal, base.rotation, robotics::Matrix3::Identity());
      slow_down(rates, bounds);
      drives.torque = joint_torque(model, rates, state.qd, bounds);
      ASSERT_TRUE(integrator.step(state, t, cycle_s, drives));
    }
    std::cout << "  largest error " << 1e3 * most_error_m << " mm, base turned by " << most_turn_deg << " deg\n";
    EXPECT_LT(most_error_m, 1.5 * each.most_error_m);
    EXPECT_LT(most_turn_deg, 1.05 * each.most_turn_deg + 1e-5);
  }
}

}  // namespace
}  // namespace hirosco::robot_arm
