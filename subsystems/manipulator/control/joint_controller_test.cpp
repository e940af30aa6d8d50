// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/joint_controller.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace hirosco::manipulator {
namespace {

constexpr double law_period_s = 0.0005;

TEST(JointController, HoldsALoadWithTheTwistOfItsStiffness) {
  // At rest u = tau_j: motor torque equals joint torque when kp (qd - theta) does.
  JointController controller{2, law_period_s};
  controller.reset({0.1, 0});
  Measured measured = Measured::zeros(2);
  measured.torque_n_m = {6, 0};
  measured.motor_position_rad = {0.1 - 6.0 / 300, 0};
  const Joints torque = controller.motor_torque({0.1, 0}, measured, {});
  EXPECT_NEAR(torque[0], 6, 1e-9);
  EXPECT_NEAR(torque[1], 0, 1e-12);
}

TEST(JointController, FiltersTheSetpointsRateAndStartsWithoutAKick) {
  JointController controller{2, law_period_s};
  controller.reset({1, 1});
  Measured measured = Measured::zeros(2);
  measured.motor_position_rad = {1, 1};
  EXPECT_EQ(controller.motor_torque({1, 1}, measured, {}), (Joints{0, 0}));
  (void)controller.motor_torque({1 + 0.001 * law_period_s, 1}, measured, {});
  EXPECT_NEAR(controller.desired_velocity_rad_s()[0], 0.2 * 0.001, 1e-12);
  (void)controller.motor_torque({1 + 0.002 * law_period_s, 1}, measured, {});
  EXPECT_NEAR(controller.desired_velocity_rad_s()[0], 0.36 * 0.001, 1e-12);
}

TEST(JointController, StaysWithinTheMotorAndMakesNothingOfADamagedSample) {
  JointController controller{2, law_period_s};
  Measured measured = Measured::zeros(2);
  EXPECT_EQ(controller.motor_torque({10, -10}, measured, {}), (Joints{60, -60}));
  measured.torque_n_m = {std::numeric_limits<double>::quiet_NaN(), 0};
  EXPECT_EQ(controller.motor_torque({10, -10}, measured, {})[0], 0);
}

TEST(JointController, GivesEachJointOfAnyNumberTheSameLawOfItsOwn) {
  // Each joint of an arm with seven asks for what the only joint of an arm with one would.
  constexpr std::size_t seven = 7;
  JointController all{seven, law_period_s};
  all.reset(Joints::zeros(seven));
  Joints wanted = Joints::zeros(seven);
  Measured measured = Measured::zeros(seven);
  for (std::size_t i = 0; i < seven; ++i) {
    wanted[i] = 0.001 * static_cast<double>(i);
    measured.torque_n_m[i] = 0.5 * static_cast<double>(i) - 1;
  }
  const Joints torque = all.motor_torque(wanted, measured, {});
  ASSERT_EQ(torque.size(), seven);
  for (std::size_t i = 0; i < seven; ++i) {
    JointController one{1, law_period_s};
    Measured its = Measured::zeros(1);
    its.torque_n_m = {measured.torque_n_m[i]};
    EXPECT_EQ(torque[i], one.motor_torque({wanted[i]}, its, {})[0]) << i;
  }
}

TEST(Effort, AsksForLittleMoreThanTheJointHoldsAlready) {
  JointController controller{2, law_period_s};
  controller.reset({1, 1});
  Measured measured = Measured::zeros(2);
  const Gains gains{.kp_n_m_per_rad = 300, .kd_n_m_s_per_rad = 24, .effort_max_n_m = 15, .surplus_max_n_m = 5};
  measured.torque_n_m = {0, -6};
  const Joints torque = controller.motor_torque({1, 1}, measured, gains);
  EXPECT_NEAR(torque[0], 4 * 5, 1e-12) << "free: the error of 1 rad asks for 300 N m";
  EXPECT_NEAR(torque[1], 4 * 5 + 3 * 6, 1e-12) << "back from a load that pulls the other way";
}

TEST(Effort, BoundsWhatTheLawAsksOfAJointAtRestWhateverTheGains) {
  JointController controller{2, law_period_s};
  controller.reset({1, 0});
  Measured measured = Measured::zeros(2);
  measured.torque_n_m = {15, 0};
  const Gains gains{.kp_n_m_per_rad = 1000, .kd_n_m_s_per_rad = 0, .effort_max_n_m = 15};
  EXPECT_NEAR(controller.motor_torque({1, 0}, measured, gains)[0], 15, 1e-12) << "in balance at the limit";
}

TEST(GainRamp, ChangesGainsAtABoundedRateAndArrivesExactly) {
  GainRamp ramp;
  ramp.reset({.kp_n_m_per_rad = 100, .kd_n_m_s_per_rad = 14});
  const Gains wanted{.kp_n_m_per_rad = 400, .kd_n_m_s_per_rad = 40};
  double last = 100;
  int cycles = 0;
  for (; !ramp.reached(wanted) && cycles < 10'000; ++cycles) {
    const Gains& now = ramp.advance(wanted, law_period_s);
    EXPECT_LE(now.kp_n_m_per_rad - last, 500 * law_period_s + 1e-9);
    last = now.kp_n_m_per_rad;
  }
  EXPECT_NEAR(cycles * law_period_s, 0.6, 2 * law_period_s) << "300 N m/rad at 500 a second";
}

}  // namespace
}  // namespace hirosco::manipulator
