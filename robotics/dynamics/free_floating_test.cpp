// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include "robotics/dynamics/dynamics.hpp"
#include "robotics/dynamics/testing/robots.hpp"

namespace hirosco::robotics {
namespace {

using testing::ball;
using testing::joint;

TEST(FreeBase, AForceBetweenTwoBodiesMovesBothByTheirMasses) {
  const double M = 10, m = 2, force = 3;
  ModelDescription description;
  description.base = ball(M, {0, 0, 0}, 1);
  description.joints = {joint(JointKind::Prismatic, Vector3::UnitX(), {0, 0, 0}, ball(m, {0.4, 0, 0}, 0.2))};
  const auto model = testing::make(description);
  Dynamics dynamics{model, Base::Free};
  dynamics.update(testing::state({0.3}, {0}));
  Coordinates forces = Coordinates::Zero(7), acceleration;
  forces[6] = force;
  ASSERT_TRUE(dynamics.forward(forces, acceleration));
  EXPECT_NEAR(acceleration[3], -force / M, 1e-13);
  EXPECT_NEAR(acceleration[6], force * (1 / M + 1 / m), 1e-13);
  EXPECT_NEAR(acceleration.head<3>().norm(), 0, 1e-13);
}

TEST(FreeBase, AWheelTurnsItsCraftTheOtherWay) {
  const double craft = 5, wheel = 0.01, torque = 0.02;
  ModelDescription description;
  description.base = ball(100, {0, 0, 0}, craft);
  // Away from the centre it makes no difference but that of its mass, which is none here.
  description.joints = {joint(JointKind::Revolute, Vector3::UnitZ(), {0.3, 0.1, 0}, ball(0, {0, 0, 0}, wheel))};
  const auto model = testing::make(description);
  Dynamics dynamics{model, Base::Free};
  dynamics.update(testing::state({1}, {0}));
  Coordinates forces = Coordinates::Zero(7), acceleration;
  forces[6] = torque;
  ASSERT_TRUE(dynamics.forward(forces, acceleration));
  EXPECT_NEAR(acceleration[2], -torque / craft, 1e-13);
  EXPECT_NEAR(acceleration[6], torque / craft + torque / wheel, 1e-12);
}

TEST(FreeBase, FallsAsAWholeWhateverItsShape) {
  const auto model = testing::tree(9, testing::Mimicry::None);
  Dynamics dynamics{model, Base::Free};
  dynamics.set_gravity({1, -2, 3});
  State state = testing::any_state(model, 1);
  state.base_twist.setZero();
  state.qd.setZero();
  dynamics.update(state);
  Coordinates acceleration;
  ASSERT_TRUE(dynamics.forward(Coordinates::Zero(15), acceleration));
  EXPECT_NEAR((state.base_orientation * Vector3{acceleration.segment<3>(3)} - Vector3{1, -2, 3}).norm(), 0, 1e-12);
  EXPECT_NEAR(acceleration.head<3>().norm() + acceleration.tail(9).norm(), 0, 1e-11);
}

/// A craft and one link in a plane, both stretched along x; without momentum the common centre of mass rests.
TEST(FreeBase, TheGeneralisedJacobianIsThatOfTwoBodiesInAPlane) {
  const double M = 40, m = 8, I0 = 3, I1 = 0.5, a = 0.6, c = 0.45, l = 1.1;
  ModelDescription description;
  description.base = ball(M, {0, 0, 0}, I0);
  description.joints = {joint(JointKind::Revolute, Vector3::UnitZ(), {a, 0, 0}, ball(m, {c, 0, 0}, I1))};
  description.frames = {{"tip", 0, {Matrix3::Identity(), {l, 0, 0}}}};
  const auto model = testing::make(description);
  Dynamics dynamics{model, Base::Free};
  State state = testing::state({0}, {0});
  state.base_position = {7, -3, 2};
  dynamics.update(state);
  Jacobian jacobian;
  ASSERT_TRUE(dynamics.generalised_jacobian({0}, jacobian));
  const double reduced = M * m / (M + m), d = a + c;
  const double base_rate = -(I1 + reduced * d * c) / (I0 + I1 + reduced * d * d);
  const double base_speed = -m / (M + m) * (base_rate * d + c);
  EXPECT_EQ(jacobian.cols(), 1);
  EXPECT_NEAR(jacobian(2, 0), 1 + base_rate, 1e-13);
  EXPECT_NEAR(jacobian(4, 0), base_speed + base_rate * (a + l) + l, 1e-13);
  EXPECT_NEAR(jacobian.col(0).cwiseAbs().sum(), std::abs(jacobian(2, 0)) + std::abs(jacobian(4, 0)), 1e-13);
}

TEST(FreeBase, TheGeneralisedJacobianMovesTheTipOfARobotThatHasNoMomentum) {
  const auto model = testing::tree(16, testing::Mimicry::EveryThird);
  Dynamics dynamics{model, Base::Free};
  State state = testing::any_state(model, 2);
  dynamics.update(state);
  MassMatrix mass;
  dynamics.mass_matrix(mass);
  state.base_twist = -mass.topLeftCorner<6, 6>().ldlt().solve(mass.block(0, 6, 6, model.joint_count()) * state.qd);
  dynamics.update(state);
  const Momentum momentum = dynamics.momentum();
  EXPECT_NEAR(momentum.linear.norm() + momentum.angular.norm(), 0, 1e-12);
  Jacobian jacobian;
  ASSERT_TRUE(dynamics.generalised_jacobian({0}, jacobian));
  EXPECT_LT((jacobian * state.qd - dynamics.frame_twist({0})).norm(), 1e-12);
}

TEST(FreeBase, MomentumIsThatOfEachBodyAboutTheCommonCentre) {
  ModelDescription description;
  description.base = ball(3, {0, 0, 0}, 0.5);
  description.joints = {joint(JointKind::Prismatic, Vector3::UnitY(), {2, 0, 0}, ball(1, {0, 0, 0}, 0.1))};
  const auto model = testing::make(description);
  Dynamics dynamics{model, Base::Free};
  State state = testing::state({0}, {4});
  state.base_position = {1e6, 0, -1e6};
  state.base_orientation = Quaternion{Eigen::AngleAxisd{std::numbers::pi / 2, Vector3::UnitZ()}};
  dynamics.update(state);
  const Momentum momentum = dynamics.momentum();
  // 1 kg with 4 m/s along the base's y, which is -x; reduced mass 3/4 at a distance of 2 m.
  EXPECT_NEAR((momentum.linear - Vector3{-4, 0, 0}).norm(), 0, 1e-12);
  EXPECT_NEAR((momentum.angular - Vector3{0, 0, 0.75 * 2 * 4}).norm(), 0, 1e-12);
  EXPECT_NEAR((dynamics.centre_of_mass() - Vector3{1e6, 0.5, -1e6}).norm(), 0, 1e-9);
}

TEST(FreeBase, ItsMassMatrixBeginsWithTheWholeRobotAsOneBody) {
  const auto model = testing::tree(7, testing::Mimicry::None);
  Dynamics dynamics{model, Base::Free};
  dynamics.update(testing::any_state(model, 8));
  MassMatrix mass;
  dynamics.mass_matrix(mass);
  const Matrix3 weight = mass.block<3, 3>(3, 3);
  EXPECT_NEAR((weight - model.mass() * Matrix3::Identity()).norm(), 0, 1e-12);
  const Matrix3 coupling = mass.block<3, 3>(0, 3);
  EXPECT_NEAR(coupling.diagonal().norm(), 0, 1e-12);
}

}  // namespace
}  // namespace hirosco::robotics
