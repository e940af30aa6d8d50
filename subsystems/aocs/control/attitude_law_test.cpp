// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/aocs/control/attitude_law.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

namespace hirosco::aocs {
namespace {

[[nodiscard]] Quaternion turned(double rad, const Vector3& axis) {
  return Quaternion{Eigen::AngleAxisd{rad, axis.normalized()}};
}

TEST(AttitudeError, IsTheRotationByWhichItIsOffInTheBasesAxes) {
  const Quaternion reference = turned(0.7, {1, 2, -1});
  for (const double rad : {1e-9, 0.03, 1.5, 3.0}) {
    const Vector3 axis = Vector3{0.2, -0.5, 1}.normalized();
    const Vector3 error = attitude_error(reference, reference * turned(rad, axis));
    EXPECT_NEAR((error - rad * axis).norm(), 0, 1e-12) << rad;
  }
}

TEST(AttitudeError, TakesTheShorterWayWhateverTheSignOfTheQuaternion) {
  Quaternion off = turned(0.1, Vector3::UnitX());
  off.coeffs() = -off.coeffs();
  EXPECT_NEAR((attitude_error(Quaternion::Identity(), off) - Vector3{0.1, 0, 0}).norm(), 0, 1e-12);
  EXPECT_NEAR(attitude_error(Quaternion::Identity(), turned(3.5, Vector3::UnitZ())).z(), 3.5 - 2 * std::numbers::pi,
              1e-12);
}

TEST(AttitudeTorque, PushesBackAndIsHeldToTheWheels) {
  const Vector3 torque = attitude_torque({0.01, -0.5, 0}, {0.002, 0, 0.1}, {6, 60}, 0.25);
  EXPECT_NEAR(torque.x(), -(6 * 0.01 + 60 * 0.002), 1e-15);
  EXPECT_EQ(torque.y(), 0.25);
  EXPECT_EQ(torque.z(), -0.25);
}

/// A body of 130 kg m2 about each axis is an oscillator of the second order: from rest it comes back as that does.
TEST(AttitudeTorque, BringsABodyBackAsTheClosedFormSays) {
  constexpr double inertia = 130, h = 0.01, begun = 0.02;
  double angle = begun, rate = 0;
  for (int i = 0; i < 3000; ++i) {
    const double torque = attitude_torque({angle, 0, 0}, {rate, 0, 0}, {}, 0.25).x();
    // Exact under a constant torque.
    angle += h * rate + h * h / 2 * torque / inertia;
    rate += h * torque / inertia;
  }
  const double decay = 60 / (2 * inertia), swing = std::sqrt(decay * decay - 6 / inertia), t = 3000 * h;
  // Overdamped: 60^2 > 4 * 6 * 130.
  const double expected = begun * std::exp(-decay * t) * (std::cosh(swing * t) + decay / swing * std::sinh(swing * t));
  EXPECT_NEAR(angle, expected, 2e-5);
}

TEST(UnloadingTorque, IsTowardsEmptyWheelsWithinWhatIsLeft) {
  const Vector3 torque = unloading_torque({4, -0.1, 0}, 0.05, {0.1, 0.1, 0});
  EXPECT_EQ(torque.x(), 0.1);
  EXPECT_NEAR(torque.y(), -0.005, 1e-15);
  EXPECT_EQ(torque.z(), 0);
}

TEST(Settled, IsToldOnceWhenItHasBeenNearAndSlowForASecond) {
  Settled settled;
  settled.begin();
  const Settled::Limits limits;
  int told = 0;
  const auto cycles = [&](int count, double error_rad) {
    for (int i = 0; i < count; ++i) told += settled.update({error_rad, 0, 0}, Vector3::Zero(), 0.01, limits) ? 1 : 0;
  };
  cycles(50, 0);
  cycles(1, 0.01);
  cycles(98, 0);
  EXPECT_EQ(told, 0);
  cycles(100, 0);
  EXPECT_EQ(told, 1);
  EXPECT_TRUE(settled.now());
  cycles(1, 0.01);
  EXPECT_FALSE(settled.now());
  cycles(150, 0);
  EXPECT_EQ(told, 2);
}

}  // namespace
}  // namespace hirosco::aocs
