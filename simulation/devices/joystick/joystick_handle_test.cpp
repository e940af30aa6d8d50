// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/joystick/joystick_handle.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "simulation/devices/robot/world/two_joint_arm.hpp"

namespace hirosco::simulation {
namespace {

constexpr Duration cycle = std::chrono::microseconds{500};

Mat2 home_jacobian() {
  const ArmParameters arm;
  return placement_of(arm, arm.home_rad).jacobian;
}

JoystickHandle a_handle(std::uint64_t seed = 1) { return {seed, home_jacobian()}; }

void run(JoystickHandle& handle, double span_s, const Vec2& torque = {}) {
  for (double t = 0; t < span_s; t += 0.0005) handle.step(torque, cycle);
}

TEST(JoystickHandle, RestsWhereTheHandAndTheMotorsBalance) {
  JoystickHandle handle = a_handle();
  handle.hand().hold({0.1, -0.05});
  run(handle, 3, {0.43, -0.215});
  EXPECT_NEAR(handle.angle_rad()[0], 0.1 + 0.43 / 4.3, 1e-6);
  EXPECT_NEAR(handle.angle_rad()[1], -0.05 - 0.215 / 4.3, 1e-6);
  EXPECT_NEAR(handle.hand_torque_n_m()[0], -0.43, 1e-5);
}

TEST(JoystickHandle, SpinsUpFreelyAgainstItsFrictionWithoutAHand) {
  HandleParameters parameters;
  parameters.hand_on = false;
  parameters.range_rad = 100;
  JoystickHandle handle{1, home_jacobian(), parameters};
  run(handle, 0.3, {0.1, 0});
  EXPECT_NEAR(handle.rate_rad_s()[0], 0.1 / 0.01 * (1 - std::exp(-0.3 * 0.01 / 0.003)), 0.02);
}

TEST(JoystickHandle, StopsAtTheEndOfItsRange) {
  JoystickHandle handle = a_handle();
  handle.hand().hold({2, 0});
  run(handle, 3);
  EXPECT_NEAR(handle.angle_rad()[0], 0.40, 0.12);
  EXPECT_LT(handle.angle_rad()[0], 0.52);
}

TEST(OperatorHand, MovesEachAxisAsASineOfItsOwn) {
  OperatorHand hand{1, home_jacobian()};
  hand.sine(0, 0.15, 0.5);
  hand.sine(1, 0.10, 1.0);
  hand.advance(0.25);
  EXPECT_NEAR(hand.intent().angle_rad[0], 0.15 * std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(hand.intent().angle_rad[1], 0.10, 1e-12);
  EXPECT_NEAR(hand.intent().rate_rad_s[1], 0, 1e-12);
}

TEST(OperatorHand, RampsAtTheTipSpeedItWasToldAndThenHolds) {
  OperatorHand hand{1, home_jacobian()};
  hand.ramp({0.065, 0}, 0.04);
  hand.advance(0.74);
  EXPECT_NEAR(times(home_jacobian(), hand.intent().angle_rad)[0], 0.0296, 1e-12);
  EXPECT_NEAR(times(home_jacobian(), hand.intent().rate_rad_s)[0], 0.04, 1e-12);
  hand.advance(2);
  EXPECT_NEAR(times(home_jacobian(), hand.intent().angle_rad)[0], 0.065, 1e-12);
  EXPECT_EQ(hand.intent().rate_rad_s, (Vec2{}));
}

TEST(OperatorHand, GoesOnFromWhereItIsWhenItChangesItsMind) {
  OperatorHand hand{1, home_jacobian()};
  hand.cartesian({0.01, 0.01}, 2);
  hand.advance(1);
  const Vec2 before = hand.intent().angle_rad;
  hand.ramp({0, 0}, 0.01);
  EXPECT_NEAR(hand.intent().angle_rad[0], before[0], 1e-12);
  hand.sine(0, 0.1, 1);
  EXPECT_NEAR(hand.intent().angle_rad[1], before[1], 1e-12);
}

TEST(OperatorHand, WandersGentlyTouchesTheWallNowAndThenAndRepeatsItselfFromItsSeed) {
  JoystickHandle one = a_handle(7), same = a_handle(7), other = a_handle(8);
  for (auto* handle : {&one, &same, &other}) handle->hand().wander();
  int touching = 0, cycles = 0;
  for (; cycles < 240'000; ++cycles) {
    for (auto* handle : {&one, &same, &other}) handle->step({}, cycle);
    const double forward_m = times(home_jacobian(), one.angle_rad())[0];
    if (forward_m > 0.01255) ++touching;
    ASSERT_LT(std::abs(one.angle_rad()[0]) + std::abs(one.angle_rad()[1]), 0.35);
    ASSERT_LT(std::abs(one.rate_rad_s()[1]), 0.3);
    ASSERT_EQ(one.angle_rad(), same.angle_rad());
  }
  EXPECT_NE(one.angle_rad(), other.angle_rad());
  EXPECT_GT(touching, cycles / 20);
  EXPECT_LT(touching, cycles / 2);
}

TEST(Random, IsNormalWithMeanZeroAndDeviationOne) {
  Random random{42};
  double sum = 0, squares = 0;
  constexpr int count = 100'000;
  for (int i = 0; i < count; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / count, 0, 0.01);
  EXPECT_NEAR(squares / count, 1, 0.02);
}

}  // namespace
}  // namespace hirosco::simulation
