// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "subsystems/robot_arm/control/laws.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

struct TorqueDriveTest : ::testing::Test {
  static constexpr double cycle_s = 0.001, torque_share = 0.8;
  robotics::Model model = testing::model_of(testing::six_axes);
  std::vector<JointBounds> bounds = testing::bounds_of(model);
  const JointVector zeros = JointVector::Zero(6);
  const JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  TorqueDrive drive;

  TorqueDriveTest() { drive.begin(6); }
  JointVector only(Eigen::Index joint, double torque) const {
    JointVector all = zeros;
    all[joint] = torque;
    return all;
  }
  const Driven& rest(const JointVector& held, double moved) {
    return drive.step({start, zeros, zeros}, {.held = held, .moved = JointVector::Constant(6, moved)}, bounds,
                      torque_share, cycle_s);
  }
};

/// Each joint to each side, for as long as it takes, with all others free to swing.
TEST_F(TorqueDriveTest, DrivesNobodyThroughTheEndOfItsRangeNorBeyondItsVelocity) {
  const auto tip = model.find_frame("tool").value();
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  dynamics.set_gravity({0, 0, -9.81});
  const JointVector rotors = JointVector::Constant(6, 0.1);
  for (Eigen::Index driven = 0; driven < 6; ++driven)
    for (const double side : {1.0, -1.0}) {
      testing::Plant plant{model};
      plant.rotor = 0.1;
      plant.step_s = 250e-6;
      plant.place(start);
      Laws laws{model, tip, cycle_s};
      laws.set(LawKind::Torque);
      drive.begin(6);
      drive.want(only(driven, side * 0.3 * bounds[static_cast<std::size_t>(driven)].effort));
      double fastest = 0, farthest = -HUGE_VAL;
      for (int i = 0; i < 3000; ++i) {
        const Measured& measured = plant.measured();
        robotics::State state;
        state.q = measured.position;
        state.qd = measured.velocity;
        dynamics.update(state);
        robotics::Coordinates held;
        robotics::MassMatrix mass;
        dynamics.bias(held);
        dynamics.mass_matrix(mass);
        laws.drive(
            drive.step(measured, {.held = held, .moved = mass.diagonal() + rotors}, bounds, torque_share, cycle_s));
        const Laws::Settings settings{.position = {.rotor = {rotors.data(), 6}, .gravity_m_s2 = {0, 0, -9.81}}};
        plant.step(laws.torque({measured.position, zeros, zeros}, measured, dynamics, {}, bounds, settings), cycle_s);
        for (std::size_t joint = 0; joint < 6; ++joint) {
          const auto j = static_cast<Eigen::Index>(joint);
          fastest = std::max(fastest, std::abs(measured.velocity[j]) / bounds[joint].motion.velocity);
          farthest = std::max(
              {farthest, measured.position[j] - bounds[joint].highest, bounds[joint].lowest - measured.position[j]});
        }
      }
      EXPECT_LT(fastest, 1.05) << driven << " " << side;
      EXPECT_LT(farthest, 0.01) << driven << " " << side;
    }
}

/// Against a wall nothing moves, and the torque is there; an arm that is free has no more of it at first than its acceleration takes.
TEST_F(TorqueDriveTest, GivesWhoPressesAllOfItsTorqueByAndBy) {
  constexpr double moved = 0.2, wanted = 10;
  drive.want(only(4, wanted));
  for (int i = 0; i < 20; ++i) rest(zeros, moved);
  EXPECT_GT(drive.driven().torque[4], 0);
  EXPECT_LE(drive.driven().torque[4], 100 * moved * bounds[4].motion.acceleration * 0.021);
  for (int i = 0; i < 1000; ++i) rest(zeros, moved);
  EXPECT_NEAR(drive.driven().torque[4], wanted, 1e-6);
  EXPECT_EQ(drive.driven().brake[4], 0);
  drive.want(zeros);
  for (int i = 0; i < 500; ++i) rest(zeros, moved);
  EXPECT_NEAR(drive.driven().torque[4], 0, 1e-3);
}

TEST_F(TorqueDriveTest, GivesNothingThatTheTorqueLimitWouldStop) {
  for (const double side : {1.0, -1.0})
    for (const double held_share : {0.5, -0.5, 0.9}) {
      drive.begin(6);
      const double effort = bounds[4].effort;
      drive.want(only(4, side * effort));
      const JointVector held = only(4, held_share * effort);
      for (int i = 0; i < 3000; ++i) {
        const Driven& driven = rest(held, 5);
        const double all = driven.torque[4] + driven.brake[4] + held[4];
        ASSERT_LE(std::abs(all), std::max(torque_share, std::abs(held_share)) * effort) << side << " " << held_share;
      }
    }
}

TEST_F(TorqueDriveTest, TakesBackWhatPushesTowardsAnEndWhereItIsThere) {
  for (const double side : {1.0, -1.0}) {
    drive.begin(6);
    drive.want(only(5, side * 10));
    Measured at_end{start, zeros, zeros};
    at_end.position[5] = side > 0 ? bounds[5].highest : bounds[5].lowest;
    const TorqueDrive::Carried carried{.held = zeros, .moved = JointVector::Constant(6, 0.2)};
    for (int i = 0; i < 1000; ++i) {
      const Driven& driven = drive.step(at_end, carried, bounds, torque_share, cycle_s);
      ASSERT_LE(side * (driven.torque[5] + driven.brake[5]), 0);
    }
    // Away from it nothing is.
    drive.want(only(5, -side * 10));
    for (int i = 0; i < 1000; ++i) drive.step(at_end, carried, bounds, torque_share, cycle_s);
    EXPECT_NEAR(drive.driven().torque[5], -side * 10, 1e-3);
  }
}

TEST_F(TorqueDriveTest, GoesOnBehindASampleThatIsNoNumber) {
  drive.want(only(4, 5));
  for (int i = 0; i < 100; ++i) rest(zeros, 0.2);
  Measured none{start, JointVector::Constant(6, std::numeric_limits<double>::quiet_NaN()), zeros};
  drive.step(none, {.held = zeros, .moved = JointVector::Constant(6, 0.2)}, bounds, torque_share, cycle_s);
  for (int i = 0; i < 1000; ++i) rest(zeros, 0.2);
  EXPECT_TRUE(drive.driven().torque.allFinite());
  EXPECT_NEAR(drive.driven().torque[4], 5, 1e-6);
}

}  // namespace
}  // namespace hirosco::robot_arm
