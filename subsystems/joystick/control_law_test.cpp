// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/joystick/control_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace hirosco::joystick {
namespace {

constexpr double period_s = 0.0005;

TEST(DisplayLaw, ShowsTheScaledTorqueAgainstTheHand) {
  PositionForce display{period_s};
  EXPECT_EQ(display.torque({{}, {10, -5}, true}, 0.02), (Axes{-0.2, 0.1}));
  EXPECT_FALSE(display.clipped());
}

TEST(DisplayLaw, StaysWithinTheMotorsAndSaysSo) {
  PositionForce display{period_s};
  EXPECT_EQ(display.torque({{}, {100, -100}, true}, 0.02), (Axes{-1.5, 1.5}));
  EXPECT_TRUE(display.clipped());
}

TEST(DisplayLaw, RampsToZeroInFourCyclesWhenThePeerFallsSilent) {
  PositionForce display{period_s};
  (void)display.torque({{}, {-20, 0}, true}, 0.02);
  constexpr std::array expected{0.3, 0.2, 0.1, 0.0, 0.0};
  for (const double torque : expected) EXPECT_NEAR(display.torque({{}, {-99, 0}, false}, 0.02)[0], torque, 1e-12);
}

TEST(DisplayLaw, ShowsNothingBeforeThePeerWasEverActive) {
  PassivePositionForce display{period_s};
  EXPECT_EQ(display.torque({{1, 1}, {10, 10}, false}, 0.02), (Axes{0, 0}));
}

TEST(DisplayLaw, MakesNothingOfADamagedSampleAndGoesOn) {
  PassivePositionForce display{period_s};
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(display.torque({{}, {nan, 0}, true}, 0.02)[0], 0);
  EXPECT_EQ(display.torque({{nan, 0}, {10, 0}, true}, 0.02)[0], 0);
  EXPECT_NEAR(display.torque({{}, {10, 0}, true}, 0.02)[0], -0.2, 1e-12);
}

/// A wall felt late: the worst case for a display. Lowest energy that came in, summed independently of the observer.
double lowest_energy_j(DisplayLaw& law) {
  double received_j = 0, lowest_j = 0;
  for (int k = 0; k < 40'000; ++k) {
    const double t = k * period_s;
    const double rate = 0.5 * std::cos(20 * t);
    const double late_position = 0.025 * std::sin(20 * (t - 0.01));
    const Axes torque = law.torque({{rate, 0}, {late_position > 0 ? 800 * late_position : 0, 0}, true}, 0.02);
    received_j -= torque[0] * rate * period_s;
    lowest_j = std::min(lowest_j, received_j);
  }
  EXPECT_NEAR(law.observed_energy_j()[0], received_j, 1e-9) << "the observer's count is the port's energy";
  return lowest_j;
}

TEST(DisplayLaw, PositionForceGivesEnergyToTheHandWhereTheWallIsFeltLate) {
  PositionForce law{period_s};
  EXPECT_LT(lowest_energy_j(law), -0.01);
  EXPECT_EQ(law.dissipated_j(), 0);
}

TEST(DisplayLaw, WithPassivityItNeverGivesMoreEnergyThanItGot) {
  PassivePositionForce law{period_s};
  EXPECT_GT(lowest_energy_j(law), -1e-4);
  EXPECT_GT(law.dissipated_j(), 0.001);
}

TEST(DisplayLaw, TakesOverTheTorqueThatAnotherLawShows) {
  PositionForce first{period_s};
  (void)first.torque({{}, {-20, 0}, true}, 0.02);
  (void)first.torque({{}, {}, false}, 0.02);
  PassivePositionForce second{period_s};
  second.take_over(first);
  EXPECT_NEAR(second.torque({{}, {}, false}, 0.02)[0], 0.2, 1e-12) << "the ramp goes on where it was";
}

TEST(DisplayLaw, ForgetsItsPastOnReset) {
  PassivePositionForce display{period_s};
  (void)display.torque({{5, 0}, {-20, 0}, true}, 0.02);
  EXPECT_GT(display.dissipated_j(), 0);
  display.reset();
  EXPECT_EQ(display.dissipated_j(), 0);
  EXPECT_EQ(display.torque({}, 0.02), (Axes{0, 0}));
}

}  // namespace
}  // namespace hirosco::joystick
