// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/stop_ramp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hirosco::robot_arm {
namespace {

constexpr double ramp_cycle_s = 0.001, fastest_joint_rad_s = 0.2;

/// Of one joint that follows with `followed_per_s`, from what it has to rest.
[[nodiscard]] double gone_by_ramp(double asked, double has) {
  StopRamp ramp;
  JointVector rates = JointVector::Constant(1, asked);
  ramp.begin(rates);
  double way = 0;
  while (!ramp.over() || std::abs(has) > 1e-9) {
    has += ramp_cycle_s * followed_per_s * (ramp.rates()[0] - has);
    way += ramp_cycle_s * has;
    ramp.go_on(ramp_cycle_s);
  }
  return way;
}

/// Over all that a joint may have and be asked for, whichever way each.
TEST(StopRamp, EndsWhereItWasToldWithinTheWayOfACycleAndNoFarther) {
  std::mt19937 random{1};
  std::uniform_real_distribution<double> any{-fastest_joint_rad_s, fastest_joint_rad_s};
  for (int i = 0; i < 2000; ++i) {
    const double asked = any(random), has = any(random);
    const double told = StopRamp::way(JointVector::Constant(1, asked), JointVector::Constant(1, has), ramp_cycle_s)[0];
    // What was told is farther that way by at most a cycle; has's own share is exact but for the cycle in which it is measured.
    const double off = told - gone_by_ramp(asked, has), most = ramp_cycle_s * (std::abs(asked) + std::abs(has));
    EXPECT_LE(std::abs(off), most) << asked << " asked, " << has << " had";
  }
  for (double rate = 0.001; rate <= fastest_joint_rad_s; rate += 0.001)
    EXPECT_GE(StopRamp::way(JointVector::Constant(1, rate), JointVector::Constant(1, rate), ramp_cycle_s)[0] + 1e-9,
              gone_by_ramp(rate, rate))
        << rate << ": never under";
}

TEST(StopRamp, LeavesTheBrakesNoLongerWay) {
  // Steadily from the same velocity within stop_within_ms of ARM.
  constexpr double brakes_s = 0.5;
  EXPECT_GE(StopRamp::span_s, brakes_s);
}

}  // namespace
}  // namespace hirosco::robot_arm
