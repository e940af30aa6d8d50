// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/dynamics/dynamics.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "robotics/dynamics/testing/robots.hpp"

namespace hirosco::robotics {
namespace {

using testing::ball;
using testing::joint;

constexpr double g = 9.81;

[[nodiscard]] Coordinates numbers(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

TEST(FixedBase, APendulumSwingsAsItsClosedFormSays) {
  const double m = 2, l = 0.7, moment = 0.1;
  ModelDescription description;
  description.joints = {joint(JointKind::Revolute, Vector3::UnitY(), {0, 0, 1}, ball(m, {0, 0, -l}, moment))};
  const auto model = testing::make(description);
  Dynamics dynamics{model, Base::Fixed};
  dynamics.set_gravity({0, 0, -g});
  for (const double q : {-2.0, 0.0, 0.3, 1.5}) {
    dynamics.update(testing::state({q}, {1.3}));
    Coordinates acceleration;
    ASSERT_TRUE(dynamics.forward(numbers({0.4}), acceleration));
    EXPECT_NEAR(acceleration[0], (0.4 - m * g * l * std::sin(q)) / (m * l * l + moment), 1e-12);
    EXPECT_NEAR(dynamics.kinetic_energy(), (m * l * l + moment) * 1.3 * 1.3 / 2, 1e-12);
    EXPECT_NEAR(dynamics.potential_energy(), m * g * (1 - l * std::cos(q)), 1e-12);
  }
}

/// Point masses on massless rods, angles from hanging, the second against the first.
TEST(FixedBase, ADoublePendulumHasTheMassMatrixAndForcesOfItsLagrangian) {
  const double m1 = 1.5, m2 = 0.8, l1 = 0.6, l2 = 0.9;
  ModelDescription description;
  description.joints = {joint(JointKind::Revolute, Vector3::UnitY(), {0, 0, 0}, ball(m1, {0, 0, -l1})),
                        joint(JointKind::Revolute, Vector3::UnitY(), {0, 0, -l1}, ball(m2, {0, 0, -l2}), 0)};
  const auto model = testing::make(description);
  Dynamics dynamics{model, Base::Fixed};
  dynamics.set_gravity({0, 0, -g});
  const double q1 = 0.4, q2 = -1.1, w1 = 0.9, w2 = 2.1;
  dynamics.update(testing::state({q1, q2}, {w1, w2}));
  const double c = std::cos(q2), s = std::sin(q2);
  MassMatrix mass;
  dynamics.mass_matrix(mass);
  EXPECT_NEAR(mass(0, 0), (m1 + m2) * l1 * l1 + m2 * l2 * l2 + 2 * m2 * l1 * l2 * c, 1e-12);
  EXPECT_NEAR(mass(0, 1), m2 * l2 * l2 + m2 * l1 * l2 * c, 1e-12);
  EXPECT_NEAR(mass(1, 0), mass(0, 1), 0);
  EXPECT_NEAR(mass(1, 1), m2 * l2 * l2, 1e-12);
  const double h = m2 * l1 * l2 * s;
  const double bias1 =
      -h * (2 * w1 * w2 + w2 * w2) + (m1 + m2) * g * l1 * std::sin(q1) + m2 * g * l2 * std::sin(q1 + q2);
  const double bias2 = h * w1 * w1 + m2 * g * l2 * std::sin(q1 + q2);
  Coordinates bias;
  dynamics.bias(bias);
  EXPECT_NEAR(bias[0], bias1, 1e-12);
  EXPECT_NEAR(bias[1], bias2, 1e-12);
  Coordinates acceleration;
  ASSERT_TRUE(dynamics.forward(numbers({0, 0}), acceleration));
  const double det = mass(0, 0) * mass(1, 1) - mass(0, 1) * mass(0, 1);
  EXPECT_NEAR(acceleration[0], (-mass(1, 1) * bias1 + mass(0, 1) * bias2) / det, 1e-11);
  EXPECT_NEAR(acceleration[1], (mass(0, 1) * bias1 - mass(0, 0) * bias2) / det, 1e-11);
}

TEST(FixedBase, ASliderFeelsTheGravityAlongItsAxis) {
  const Vector3 axis = Vector3{1, 0, 1}.normalized();
  ModelDescription description;
  description.joints = {joint(JointKind::Prismatic, axis, {0, 0, 0}, ball(4, {0.1, 0.2, 0.3}, 7))};
  const auto model = testing::make(description);
  Dynamics dynamics{model, Base::Fixed};
  dynamics.set_gravity({0, 0, -g});
  dynamics.update(testing::state({0.5}, {2}));
  Coordinates acceleration;
  ASSERT_TRUE(dynamics.forward(numbers({8}), acceleration));
  EXPECT_NEAR(acceleration[0], 8.0 / 4 - g / std::sqrt(2), 1e-12);
  // A base that lies on its side has the axis elsewhere.
  State turned = testing::state({0.5}, {2});
  turned.base_orientation = Quaternion{Eigen::AngleAxisd{-std::numbers::pi / 4, Vector3::UnitY()}};
  dynamics.update(turned);
  ASSERT_TRUE(dynamics.forward(numbers({8}), acceleration));
  EXPECT_NEAR(acceleration[0], 8.0 / 4 - g, 1e-12);
}

TEST(FixedBase, TwoSlidersOfOneCoordinateWeighByTheSquareOfTheRatio) {
  ModelDescription description;
  description.joints = {joint(JointKind::Prismatic, Vector3::UnitX(), {0, 0, 0}, ball(3, {0, 0, 0})),
                        joint(JointKind::Prismatic, Vector3::UnitX(), {0, 0, 0}, ball(5, {0, 0, 0}))};
  description.joints[1].mimic = Mimic{0, -2, 0.25};
  description.frames = {{"other", 1, {}}};
  const auto model = testing::make(description);
  Dynamics dynamics{model, Base::Fixed};
  dynamics.set_gravity({-1, 0, 0});
  dynamics.update(testing::state({0.5}, {3}));
  EXPECT_NEAR(dynamics.frame_pose({0}).position.x(), -2 * 0.5 + 0.25, 1e-15);
  EXPECT_NEAR(dynamics.frame_twist({0})[3], -6, 1e-15);
  Coordinates acceleration;
  ASSERT_TRUE(dynamics.forward(numbers({46}), acceleration));
  // 3 + 4*5 kg, and the weight of the second pulls the other way: -3 + 2*5.
  EXPECT_NEAR(acceleration[0], (46 + 7) / 23.0, 1e-12);
  EXPECT_NEAR(dynamics.kinetic_energy(), 23 * 9 / 2.0, 1e-12);
}

TEST(FixedBase, WhatHasNoInertiaIsToldAndNotDividedBy) {
  ModelDescription description;
  description.joints = {joint(JointKind::Revolute, Vector3::UnitZ(), {0, 0, 0}, ball(1, {0, 0, 1}))};
  const auto model = testing::make(description);
  Dynamics dynamics{model, Base::Fixed};
  dynamics.update(testing::state({0}, {0}));
  Coordinates acceleration;
  const auto made = dynamics.forward(numbers({1}), acceleration);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::OutOfRange);
}

class AnyTree : public ::testing::TestWithParam<std::tuple<Base, testing::Mimicry, int>> {
 protected:
  const Base base_{std::get<0>(GetParam())};
  const Model model_{testing::tree(std::get<2>(GetParam()), std::get<1>(GetParam()))};
  Dynamics dynamics_{model_, base_};
  void SetUp() override { dynamics_.set_gravity({0.3, -0.2, -g}); }
};

TEST_P(AnyTree, ForwardIsTheReverseOfInverse) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    dynamics_.update(testing::any_state(model_, seed));
    const Coordinates force = Coordinates::LinSpaced(dynamics_.coordinate_count(), -2, 3);
    Coordinates acceleration, again;
    ASSERT_TRUE(dynamics_.forward(force, acceleration));
    dynamics_.inverse(acceleration, again);
    EXPECT_LT((again - force).cwiseAbs().maxCoeff(), 1e-9 * (1 + acceleration.cwiseAbs().maxCoeff()));
  }
}

TEST_P(AnyTree, TheMassMatrixIsWhatInverseSaysOfOneAccelerationAfterTheOther) {
  dynamics_.update(testing::any_state(model_, 3));
  MassMatrix mass;
  Coordinates bias, force;
  dynamics_.mass_matrix(mass);
  dynamics_.bias(bias);
  for (int i = 0; i < dynamics_.coordinate_count(); ++i) {
    dynamics_.inverse(Coordinates::Unit(dynamics_.coordinate_count(), i), force);
    EXPECT_LT((force - bias - mass.col(i)).cwiseAbs().maxCoeff(), 1e-10);
  }
  EXPECT_EQ((mass - mass.transpose()).cwiseAbs().maxCoeff(), 0);
}

TEST_P(AnyTree, EnergyIsHalfTheMassMatrixBetweenVelocities) {
  const State state = testing::any_state(model_, 4);
  dynamics_.update(state);
  Coordinates velocity(dynamics_.coordinate_count());
  if (base_ == Base::Free) velocity.head<6>() = state.base_twist;
  velocity.tail(model_.joint_count()) = state.qd;
  MassMatrix mass;
  dynamics_.mass_matrix(mass);
  EXPECT_NEAR(dynamics_.kinetic_energy(), velocity.dot(mass * velocity) / 2, 1e-10);
}

/// Where everything is a little later, by differences.
TEST_P(AnyTree, JacobianAndDriftAreTheFirstAndSecondDerivativeOfWhereATipIs) {
  const FrameId tip{0};
  const State state = testing::any_state(model_, 5);
  const auto after = [&](double t) {
    State moved = state;
    moved.q += t * state.qd;
    if (base_ == Base::Fixed) return moved;
    // The numbers of the twist stay: a screw.
    const Vector3 w = state.base_twist.head<3>();
    const Vector3 v = state.base_twist.tail<3>();
    const double angle = w.norm() * t;
    const Vector3 axis = w.normalized();
    const Matrix3 cross = cross_matrix(axis);
    const Vector3 way =
        t * v + (1 - std::cos(angle)) / w.norm() * cross * v + (t - std::sin(angle) / w.norm()) * cross * cross * v;
    moved.base_position += state.base_orientation * way;
    moved.base_orientation = state.base_orientation * Quaternion{Eigen::AngleAxisd{angle, axis}};
    return moved;
  };
  const double h = 1e-4;
  const auto at = [&](double t) {
    dynamics_.update(after(t));
    return std::pair{dynamics_.frame_pose(tip).position, dynamics_.frame_twist(tip)};
  };
  const auto [before_at, before_twist] = at(-h);
  const auto [later_at, later_twist] = at(h);
  dynamics_.update(state);
  Coordinates velocity(dynamics_.coordinate_count());
  if (base_ == Base::Free) velocity.head<6>() = state.base_twist;
  velocity.tail(model_.joint_count()) = state.qd;
  Jacobian jacobian;
  dynamics_.jacobian(tip, jacobian);
  EXPECT_LT((jacobian * velocity - dynamics_.frame_twist(tip)).norm(), 1e-12);
  EXPECT_LT(((later_at - before_at) / (2 * h) - dynamics_.frame_twist(tip).tail<3>()).norm(), 1e-6);
  EXPECT_LT(((later_twist - before_twist) / (2 * h) - dynamics_.frame_drift(tip)).norm(), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(All, AnyTree,
                         ::testing::Combine(::testing::Values(Base::Fixed, Base::Free),
                                            ::testing::Values(testing::Mimicry::None, testing::Mimicry::EveryThird),
                                            ::testing::Values(1, 7, 16)));

}  // namespace
}  // namespace hirosco::robotics
