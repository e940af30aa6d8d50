// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "subsystems/robot_arm/control/homing_law.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

struct HomingLawTest : ::testing::Test {
  static constexpr double cycle_s = 0.001;
  robotics::Model model = testing::model_of(testing::six_axes);
  const JointVector zeros = JointVector::Zero(6);
  std::array<double, 6> rotor{0.1, 0.1, 0.1, 0.1, 0.1, 0.1}, most{15, 15, 12, 5, 5, 5};
  HomingLaw law{model, cycle_s};

  JointVector torque(const JointVector& error, const JointVector& measured_torque) {
    return law.torque({error, zeros, zeros}, {zeros, zeros, measured_torque}, {.rotor = rotor, .most = most});
  }
  [[nodiscard]] static JointVector only(Eigen::Index joint, double value) {
    JointVector all = JointVector::Zero(6);
    all[joint] = value;
    return all;
  }
};

/// Stretched, folded and across, each with what it tells shifted by whatever its encoders began with: the law sees errors alone.
TEST_F(HomingLawTest, HoldsAnArmThatWeighsNothingInEveryPosture) {
  for (const auto& posture : {std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1}, std::array{0.0, 0.0, 0.0, 0.0, 0.0, 0.0},
                              std::array{-1.0, 1.5, -2.4, 1.9, -1.2, 2.0}}) {
    testing::Plant plant{model};
    plant.set_gravity({0, 0, 0});
    plant.rotor = 0.1;
    plant.place(vector_of(posture));
    law.begin();
    JointVector push = only(1, 8);
    const Setpoint wanted{plant.measured().position, zeros, zeros};
    for (int i = 0; i < 2000; ++i) {
      const JointVector put_out = law.torque(wanted, plant.measured(), {.rotor = rotor, .most = most});
      ASSERT_TRUE((put_out.array().abs() <= Eigen::Map<const Eigen::Array<double, 6, 1>>(most.data())).all());
      plant.step(put_out, cycle_s, i < 200 ? &push : nullptr);
      ASSERT_LT((plant.measured().position - wanted.position).cwiseAbs().maxCoeff(), 0.05) << i;
    }
    EXPECT_LT((plant.measured().position - wanted.position).cwiseAbs().maxCoeff(), 5e-3);
    EXPECT_LT(plant.measured().velocity.cwiseAbs().maxCoeff(), 5e-3);
  }
}

TEST_F(HomingLawTest, GivesNoJointMoreThanItsBoundHoweverFarItIsOffAndWhateverIsNoNumber) {
  for (const double off : {1e-6, 0.01, 3.0, 1e9, -1e9}) {
    for (int i = 0; i < 100; ++i) {
      const JointVector given = torque(JointVector::Constant(6, off), zeros);
      for (Eigen::Index joint = 0; joint < 6; ++joint)
        ASSERT_LE(std::abs(given[joint]), most.at(static_cast<std::size_t>(joint))) << off;
    }
  }
  law.begin();
  EXPECT_EQ(torque(only(2, std::numeric_limits<double>::quiet_NaN()), zeros)[2], 0);
  EXPECT_GT(torque(only(2, 1e-3), zeros)[2], 0) << "and goes on behind it";
}

TEST_F(HomingLawTest, SaysWhoHasHadAllOfItsTorqueForTwentyMilliseconds) {
  for (int i = 0; i < 19; ++i) static_cast<void>(torque(only(3, 1), zeros));
  EXPECT_FALSE(law.presses());
  static_cast<void>(torque(only(3, 1), zeros));
  EXPECT_EQ(law.presses(), 3U);
  static_cast<void>(torque(zeros, zeros));
  EXPECT_FALSE(law.presses());
}

TEST_F(HomingLawTest, SaysWhoseSensorFeelsMoreThanItsTorque) {
  for (int i = 0; i < 20; ++i) static_cast<void>(torque(zeros, only(4, 5.1)));
  EXPECT_EQ(law.presses(), 4U);
}

TEST_F(HomingLawTest, LearnsWhatPullsAtAJointAndNotBeyondItsBound) {
  double given = 0;
  for (int i = 0; i < 500; ++i) given = torque(only(0, 0.005), zeros)[0];
  const double at_first = 3 * 40 * 40 * 0.1 * 0.005;
  EXPECT_GT(given, 1.2 * at_first);
  for (int i = 0; i < 20'000; ++i) given = torque(only(0, 0.005), zeros)[0];
  EXPECT_LE(given, most[0]);
  given = torque(only(0, -0.005), zeros)[0];
  EXPECT_LT(given, most[0]) << "it is not wound up";
}

}  // namespace
}  // namespace hirosco::robot_arm
