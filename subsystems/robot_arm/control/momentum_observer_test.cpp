// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "subsystems/robot_arm/control/momentum_observer.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

using testing::model_of;
using testing::Plant;

struct MomentumObserverTest : ::testing::Test {
  static constexpr double cycle_s = 0.001, gain_per_s = 50;
  robotics::Model model = model_of(testing::six_axes);
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  MomentumObserver observer{6, cycle_s, gain_per_s};
  Plant plant{model};

  MomentumObserverTest() { dynamics.set_gravity({0, 0, -9.81}); }
  /// Moves freely under gravity and these drives.
  void run(const JointVector& drive, double seconds, const JointVector* outside = nullptr) {
    for (double t = 0; t < seconds; t += cycle_s) {
      plant.step(drive, cycle_s, outside);
      robotics::State state;
      state.q = plant.measured().position;
      state.qd = plant.measured().velocity;
      dynamics.update(state);
      observer.update(plant.measured(), dynamics, robotics::Coordinates::Zero(6));
    }
  }
};

TEST_F(MomentumObserverTest, SeesNothingInAnArmThatMovesFast) {
  plant.place(vector_of(std::array{0.1, 0.4, 0.5, 0.2, 0.3, 0.1}));
  run(vector_of(std::array{8.0, -30.0, -10.0, 2.0, 1.0, 0.5}), 0.4);
  EXPECT_GT(plant.measured().velocity.cwiseAbs().maxCoeff(), 1);
  EXPECT_LT(observer.external().cwiseAbs().maxCoeff(), 0.5);
}

TEST_F(MomentumObserverTest, TellsAPushBehindAFilterOfFirstOrderAndOfItsJointAlone) {
  plant.place(vector_of(std::array{0.1, 0.4, 0.5, 0.2, 0.3, 0.1}));
  const JointVector zeros = JointVector::Zero(6);
  run(zeros, 0.02);
  JointVector push = zeros;
  push[1] = 20;
  run(zeros, 1 / gain_per_s, &push);
  EXPECT_NEAR(observer.external()[1], 20 * (1 - std::exp(-1)), 0.7);
  run(zeros, 5 / gain_per_s, &push);
  EXPECT_NEAR(observer.external()[1], 20, 0.5);
  for (const Eigen::Index i : {0, 2, 3, 4, 5}) EXPECT_NEAR(observer.external()[i], 0, 1) << i;
}

}  // namespace
}  // namespace hirosco::robot_arm
