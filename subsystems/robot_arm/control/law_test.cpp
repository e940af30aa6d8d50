// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "subsystems/robot_arm/control/law.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

using testing::bounds_of;
using testing::model_of;
using testing::Plant;

const Law::Settings settings{.gravity_m_s2 = {0, 0, -9.81}};

struct LawTest : ::testing::Test {
  static constexpr double cycle_s = 0.001;
  robotics::Model model = model_of(testing::six_axes);
  std::vector<JointBounds> bounds = bounds_of(model);
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  robotics::FrameId tip = model.find_frame("tool").value();
  Law law{model, tip, cycle_s};
  Setpoint wanted;
  Payload payload;

  LawTest() {
    dynamics.set_gravity({0, 0, -9.81});
    wanted.position = vector_of(std::array{0.3, 0.9, 0.8, -0.5, 0.4, 0.2});
    wanted.velocity = wanted.acceleration = JointVector::Zero(6);
  }
  JointVector torque(const Measured& measured) {
    robotics::State state;
    state.q = measured.position;
    state.qd = measured.velocity;
    dynamics.update(state);
    return law.torque(wanted, measured, dynamics, payload, bounds, settings);
  }
  void run(Plant& plant, double seconds) {
    for (double t = 0; t < seconds; t += cycle_s) plant.step(torque(plant.measured()), cycle_s);
  }
  double error(const Plant& plant) const { return (wanted.position - plant.measured().position).cwiseAbs().maxCoeff(); }
};

TEST_F(LawTest, AtItsSetpointGivesWhatGravityTakesAndNothingElse) {
  const JointVector zeros = JointVector::Zero(6);
  const JointVector given = torque({wanted.position, zeros, zeros});
  robotics::Coordinates gravity;
  dynamics.bias(gravity);
  EXPECT_LT((given - gravity).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(gravity.cwiseAbs().maxCoeff(), 10);
}

TEST_F(LawTest, MeetsAnErrorWithTheSameAccelerationInEveryJoint) {
  const JointVector zeros = JointVector::Zero(6);
  Measured measured{wanted.position - 0.002 * JointVector::Ones(6), zeros, zeros};
  const JointVector given = torque(measured);
  robotics::Coordinates acceleration;
  ASSERT_TRUE(dynamics.forward(robotics::Coordinates{given}, acceleration));
  // 3 w2 e, and what the integral has learnt in one cycle.
  const double w = settings.bandwidth_rad_s, expected = 3 * w * w * 0.002 + w * w * w * 0.002 * cycle_s;
  ASSERT_FALSE(law.saturated());
  for (Eigen::Index i = 0; i < 6; ++i) EXPECT_NEAR(acceleration[i], expected, 1e-6 * expected) << i;
}

TEST_F(LawTest, HoldsALinksATenthHeavierWithFrictionWithinAMilliradian) {
  const robotics::Model heavier = model_of(testing::six_axes, 1.1);
  Plant plant{heavier};
  plant.place(wanted.position);
  run(plant, 0.1);
  EXPECT_GT(error(plant), 1e-4) << "the model does not know";
  run(plant, 0.9);
  EXPECT_LT(error(plant), 1e-3);
}

TEST_F(LawTest, ComesToItsSetpointThoughAJointsDryFrictionIsMoreThanItsShareOfTheIntegral) {
  // A light joint of a weak drive that sticks: where it is said to, its friction is the model's, too.
  auto sticks = testing::described(testing::six_axes);
  sticks.joints[5].limits.effort = 2.8;
  sticks.joints[5].friction = 2.0;
  model = robotics::Model::make(sticks).value();
  bounds = bounds_of(model);
  ASSERT_LT(settings.integral_share * bounds[5].effort, 1);
  Plant plant{model};
  JointVector beside = wanted.position;
  beside[5] -= 0.005;
  plant.place(beside);
  run(plant, 3);
  EXPECT_LT(error(plant), 1e-3);
}

TEST_F(LawTest, HoldsAPayloadThatItWasToldOfFromTheFirstCycleOn) {
  payload = {2, {0.05, 0.1, -0.02}};
  const JointVector zeros = JointVector::Zero(6);
  const Measured measured{wanted.position, zeros, zeros};
  const JointVector with = torque(measured);
  // Virtual work: what lifting the point by each joint takes.
  const auto height = [&](const JointVector& q) {
    robotics::State state;
    state.q = q;
    state.qd = zeros;
    dynamics.update(state);
    return (dynamics.frame_pose(tip) * payload.place_m).z();
  };
  payload.mass_kg = 0;
  law.reset();
  const JointVector without = torque(measured);
  payload.mass_kg = 2;
  for (Eigen::Index i = 0; i < 6; ++i) {
    constexpr double h = 1e-6;
    JointVector up = wanted.position, down = wanted.position;
    up[i] += h;
    down[i] -= h;
    EXPECT_NEAR(with[i] - without[i], 2 * 9.81 * (height(up) - height(down)) / (2 * h), 1e-6) << i;
  }
}

TEST_F(LawTest, GivesNoMoreThanEachJointsEffortWhateverIsAsked) {
  const JointVector zeros = JointVector::Zero(6);
  for (const double far : {10.0, -10.0}) {
    wanted.position = far * JointVector::Ones(6);
    const JointVector given = torque({zeros, zeros, zeros});
    EXPECT_TRUE(law.saturated());
    for (std::size_t i = 0; i < 6; ++i) EXPECT_LE(std::abs(given[static_cast<Eigen::Index>(i)]), bounds[i].effort) << i;
  }
}

TEST_F(LawTest, GivesNothingForWhatIsNoNumber) {
  const JointVector zeros = JointVector::Zero(6);
  Measured measured{wanted.position, zeros, zeros};
  measured.position[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(torque(measured).allFinite());
}

}  // namespace
}  // namespace hirosco::robot_arm
