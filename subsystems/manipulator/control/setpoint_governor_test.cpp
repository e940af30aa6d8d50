// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/setpoint_governor.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace hirosco::manipulator {
namespace {

constexpr double cycle_s = 0.0005;

TEST(SetpointGovernor, FollowsWithoutLagWhatMovesWithinItsBounds) {
  SetpointGovernor governor{nullptr};
  governor.reset({0, 0});
  double worst = 0;
  for (int k = 1; k < 8000; ++k) {
    // 0.15 rad at 1 Hz: 0.94 rad/s, 5.9 rad/s2, as a hand begins it.
    const double asked = 0.15 * (1 - std::cos(2 * 3.14159265358979 * k * cycle_s));
    const double followed = governor.advance({asked, 0}, {asked, 0}, {}, cycle_s)[0];
    worst = std::max(worst, std::abs(followed - asked));
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(SetpointGovernor, MakesOfAJumpAMotionWithinSpeedAndAccelerationThatEndsThere) {
  SetpointGovernor governor{nullptr};
  governor.reset({0, 0});
  const SetpointGovernor::Bounds bounds{.motion = {.speed_rad_s = 1, .acceleration_rad_s2 = 30}, .lead_rad = 10};
  double last = 0, last_speed = 0, fastest = 0, hardest = 0;
  for (int k = 0; k < 4000; ++k) {
    const double at = governor.advance({-0.8, 0}, {last, 0}, bounds, cycle_s)[0];
    const double speed = (at - last) / cycle_s;
    // The grain is taken at once, at both ends.
    if (k > 0 && at != -0.8) {
      fastest = std::max(fastest, std::abs(speed));
      if (k > 1) hardest = std::max(hardest, std::abs(speed - last_speed) / cycle_s);
    }
    last = at;
    last_speed = speed;
  }
  EXPECT_LE(fastest, 1 + 1e-9);
  EXPECT_LE(hardest, 30 + 1e-6);
  EXPECT_EQ(last, -0.8);
}

TEST(SetpointGovernor, DoesNotRunAwayFromAnArmThatCannotFollow) {
  for (std::size_t joints = 1; joints <= max_joints; ++joints) {
    SetpointGovernor governor{nullptr};
    const Joints still = Joints::zeros(joints);
    Joints asked = still, at = still;
    for (std::size_t i = 0; i < joints; ++i) asked[i] = i % 2 == 0 ? -1 : 1;
    governor.reset(still);
    for (int k = 0; k < 4000; ++k) at = governor.advance(asked, still, {.motion = {}, .lead_rad = 0.05}, cycle_s);
    for (std::size_t i = 0; i < joints; ++i)
      EXPECT_NEAR(at[i], 0.05 * asked[i], SetpointGovernor::grain_rad + 1e-12) << i;
  }
}

/// A wall that the first joint comes to: 0.1 m a radian, at 1 rad.
struct Wall final : Surface {
  [[nodiscard]] double gap_m(const Joints& position_rad) const noexcept override { return 0.1 * (1 - position_rad[0]); }
};

TEST(SetpointGovernor, ComesToASurfaceNoFasterThanItsContactSpeed) {
  const Wall wall;
  SetpointGovernor governor{&wall};
  Joints at{0.9, 0};
  governor.reset(at);
  double last = at[0], fastest_there_m_s = 0, fastest_m_s = 0;
  for (int k = 0; k < 1000; ++k) {
    at = governor.advance({1.5, 0}, at, {}, cycle_s);
    const double speed_m_s = 0.1 * (at[0] - last) / cycle_s;
    if (k > 0) fastest_m_s = std::max(fastest_m_s, speed_m_s);
    // What is given is ahead of the setpoint by the grain.
    if (k > 0 && last > 1 + SetpointGovernor::grain_rad) fastest_there_m_s = std::max(fastest_there_m_s, speed_m_s);
    last = at[0];
  }
  EXPECT_LE(fastest_there_m_s, 0.060 + 1e-9);
  EXPECT_GT(fastest_m_s, 0.08) << "farther off it is faster";
  EXPECT_GT(last, 1.05) << "it goes on, slowly";
}

TEST(SetpointGovernor, TakesWhatIsNoNumberForNothingAsked) {
  constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
  SetpointGovernor governor{nullptr};
  const Joints away{-0.8, 2.2};
  governor.reset(away);
  EXPECT_EQ(governor.advance({no_number, no_number}, away, {}, cycle_s), away);
  EXPECT_EQ(governor.advance(away, away, {}, cycle_s), away);
}

TEST(BoundsFor, GrowWithTheEffortThatMayBeAskedOfAJoint) {
  EXPECT_NEAR(bounds_for(15, 300).lead_rad, 0.05, 1e-12);
  EXPECT_NEAR(bounds_for(100, 300).motion.speed_rad_s / bounds_for(15, 300).motion.speed_rad_s, 100.0 / 15, 1e-12);
}

}  // namespace
}  // namespace hirosco::manipulator
