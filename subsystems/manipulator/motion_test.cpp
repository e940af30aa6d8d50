// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace hirosco::manipulator {
namespace {

constexpr double cycle_s = 0.0005;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

TEST(ShortestDuration, KeepsAMinimumJerkMotionWithinItsSpeedAndItsAcceleration) {
  for (const double way : {0.01, 0.1, 0.5, 2.0}) {
    const MotionLimits limits{.speed_rad_s = 1, .acceleration_rad_s2 = 10};
    const double duration_s = shortest_duration_s({0, 0.3}, {way, 0.3}, limits);
    Trajectory motion;
    motion.start({0, 0.3}, {way, 0.3}, duration_s);
    double last = 0, last_speed = 0, fastest = 0, hardest = 0;
    constexpr int steps = 4000;
    for (int k = 0; k < steps; ++k) {
      const double at = motion.advance(duration_s / steps)[0];
      const double speed = (at - last) * steps / duration_s;
      if (k > 0) hardest = std::max(hardest, std::abs(speed - last_speed) * steps / duration_s);
      fastest = std::max(fastest, speed);
      last = at;
      last_speed = speed;
    }
    EXPECT_LE(fastest, 1.001);
    EXPECT_LE(hardest, 10.01);
    EXPECT_TRUE(fastest > 0.999 || hardest > 9.99) << "and is no slower than it must be";
  }
}

TEST(GainRamp, ChangesGainsAtABoundedRateAndArrivesExactly) {
  GainRamp ramp;
  ramp.reset({.kp_n_m_per_rad = 100, .kd_n_m_s_per_rad = 14});
  const Gains wanted{.kp_n_m_per_rad = 400, .kd_n_m_s_per_rad = 40};
  double last = 100;
  int cycles = 0;
  for (; !ramp.reached(wanted) && cycles < 10'000; ++cycles) {
    const Gains& now = ramp.advance(wanted, cycle_s);
    EXPECT_LE(now.kp_n_m_per_rad - last, 500 * cycle_s + 1e-9);
    last = now.kp_n_m_per_rad;
  }
  EXPECT_NEAR(cycles * cycle_s, 0.6, 2 * cycle_s) << "300 N m/rad at 500 a second";
}

/// Far from the contour.
constexpr Joints away{-0.8, 2.2};

TEST(SetpointGovernor, FollowsWithoutLagWhatMovesWithinItsBounds) {
  SetpointGovernor governor{{}};
  governor.reset(away);
  double worst = 0;
  for (int k = 1; k < 8000; ++k) {
    // 0.15 rad at 1 Hz: 0.94 rad/s, 5.9 rad/s2, as a hand begins it.
    const double asked = away[0] + 0.15 * (1 - std::cos(2 * 3.14159265358979 * k * cycle_s));
    const double followed = governor.advance({asked, away[1]}, {asked, away[1]}, {}, cycle_s)[0];
    worst = std::max(worst, std::abs(followed - asked));
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(SetpointGovernor, MakesOfAJumpAMotionWithinSpeedAndAccelerationThatEndsThere) {
  SetpointGovernor governor{{}};
  governor.reset(away);
  const SetpointGovernor::Bounds bounds{.motion = {.speed_rad_s = 1, .acceleration_rad_s2 = 30}, .lead_rad = 10};
  double last = away[0], last_speed = 0, fastest = 0, hardest = 0;
  for (int k = 0; k < 4000; ++k) {
    const double at = governor.advance({away[0] - 0.8, away[1]}, {last, away[1]}, bounds, cycle_s)[0];
    const double speed = (at - last) / cycle_s;
    // The grain is taken at once, at both ends.
    if (k > 0 && at != away[0] - 0.8) {
      fastest = std::max(fastest, std::abs(speed));
      if (k > 1) hardest = std::max(hardest, std::abs(speed - last_speed) / cycle_s);
    }
    last = at;
    last_speed = speed;
  }
  EXPECT_LE(fastest, 1 + 1e-9);
  EXPECT_LE(hardest, 30 + 1e-6);
  EXPECT_EQ(last, away[0] - 0.8);
}

TEST(SetpointGovernor, DoesNotRunAwayFromAnArmThatCannotFollow) {
  SetpointGovernor governor{{}};
  governor.reset(away);
  Joints at{};
  for (int k = 0; k < 4000; ++k)
    at = governor.advance({away[0] - 1, away[1] + 1}, away, {.motion = {}, .lead_rad = 0.05}, cycle_s);
  EXPECT_NEAR(at[0], away[0] - 0.05, SetpointGovernor::grain_rad + 1e-12);
  EXPECT_NEAR(at[1], away[1] + 0.05, SetpointGovernor::grain_rad + 1e-12);
}

TEST(SetpointGovernor, BringsTheTipToTheContourNoFasterThanItsContactSpeed) {
  SetpointGovernor governor{{}};
  const Geometry geometry;
  Joints at{-0.8, 1.6};  // 12.55 mm from the rail
  governor.reset(at);
  double last_x = tip(geometry, at)[0], fastest_there = 0, fastest = 0;
  for (int k = 0; k < 1000; ++k) {
    at = governor.advance({-0.8, 1.2}, at, {}, cycle_s);
    const double x = tip(geometry, at)[0];
    if (k > 0 && x > 0.339) fastest_there = std::max(fastest_there, (x - last_x) / cycle_s);
    if (k > 0) fastest = std::max(fastest, (x - last_x) / cycle_s);
    last_x = x;
  }
  EXPECT_LT(fastest_there, 0.060 + 20 * 0.0015);
  EXPECT_GT(fastest, 0.08) << "farther off it is faster";
  EXPECT_GT(last_x, 0.35) << "it goes on, slowly";
}

TEST(SetpointGovernor, TakesWhatIsNoNumberForNothingAsked) {
  SetpointGovernor governor{{}};
  governor.reset(away);
  EXPECT_EQ(governor.advance({no_number, no_number}, away, {}, cycle_s), away);
  EXPECT_EQ(governor.advance(away, away, {}, cycle_s), away);
}

TEST(BoundsFor, GrowWithTheEffortThatMayBeAskedOfAJoint) {
  EXPECT_NEAR(bounds_for(15, 300).lead_rad, 0.05, 1e-12);
  EXPECT_NEAR(bounds_for(100, 300).motion.speed_rad_s / bounds_for(15, 300).motion.speed_rad_s, 100.0 / 15, 1e-12);
}

TEST(Arrival, IsMeasuredAndMissedWhenItDoesNotComeInTime) {
  Arrival arrival;
  arrival.start();
  EXPECT_EQ(arrival.judge({0.1, 0}, {0.104, 0}, 0.005, cycle_s), Arrival::Verdict::There);
  int cycles = 0;
  while (arrival.judge({0.1, 0}, {0.1, 0.006}, 0.005, cycle_s) == Arrival::Verdict::UnderWay) ++cycles;
  EXPECT_NEAR(cycles * cycle_s, Arrival::patience_s, 2 * cycle_s);
  EXPECT_NEAR(arrival.error_rad(), 0.006, 1e-12);
  arrival.start();
  EXPECT_NE(arrival.judge({no_number, 0}, {0, 0}, 0.005, cycle_s), Arrival::Verdict::There);
}

TEST(Effort, AsksForLittleMoreThanTheJointHoldsAlready) {
  JointController controller{cycle_s};
  controller.reset({1, 1});
  Measured measured;
  const Gains gains{.kp_n_m_per_rad = 300, .kd_n_m_s_per_rad = 24, .effort_max_n_m = 15, .surplus_max_n_m = 5};
  measured.torque_n_m = {0, -6};
  const Joints torque = controller.motor_torque({1, 1}, measured, gains);
  EXPECT_NEAR(torque[0], 4 * 5, 1e-12) << "free: the error of 1 rad asks for 300 N m";
  EXPECT_NEAR(torque[1], 4 * 5 + 3 * 6, 1e-12) << "back from a load that pulls the other way";
}

TEST(Effort, BoundsWhatTheLawAsksOfAJointAtRestWhateverTheGains) {
  JointController controller{cycle_s};
  controller.reset({1, 0});
  Measured measured;
  measured.torque_n_m = {15, 0};
  const Gains gains{.kp_n_m_per_rad = 1000, .kd_n_m_s_per_rad = 0, .effort_max_n_m = 15};
  EXPECT_NEAR(controller.motor_torque({1, 0}, measured, gains)[0], 15, 1e-12) << "in balance at the limit";
}

}  // namespace
}  // namespace hirosco::manipulator
