// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/joystick/control_law.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace hirosco::joystick {
namespace {

constexpr double period_s = 0.0005;

TEST(ForceDisplay, ShowsTheScaledTorqueAgainstTheHand) {
  ForceDisplay display{period_s};
  EXPECT_EQ(display.torque({{}, {10, -5}, true}, {0.02, false}), (Axes{-0.2, 0.1}));
  EXPECT_FALSE(display.clipped());
}

TEST(ForceDisplay, StaysWithinTheMotorsAndSaysSo) {
  ForceDisplay display{period_s};
  EXPECT_EQ(display.torque({{}, {100, -100}, true}, {0.02, false}), (Axes{-1.5, 1.5}));
  EXPECT_TRUE(display.clipped());
}

TEST(ForceDisplay, RampsToZeroInFourCyclesWhenThePeerFallsSilent) {
  ForceDisplay display{period_s};
  (void)display.torque({{}, {-20, 0}, true}, {0.02, false});
  constexpr std::array expected{0.3, 0.2, 0.1, 0.0, 0.0};
  for (const double torque : expected)
    EXPECT_NEAR(display.torque({{}, {-99, 0}, false}, {0.02, false})[0], torque, 1e-12);
}

TEST(ForceDisplay, ShowsNothingBeforeThePeerWasEverActive) {
  ForceDisplay display{period_s};
  EXPECT_EQ(display.torque({{1, 1}, {10, 10}, false}, {0.02, true}), (Axes{0, 0}));
}

TEST(ForceDisplay, MakesNothingOfADamagedSampleAndGoesOn) {
  ForceDisplay display{period_s};
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(display.torque({{}, {nan, 0}, true}, {0.02, true})[0], 0);
  EXPECT_EQ(display.torque({{nan, 0}, {10, 0}, true}, {0.02, true})[0], 0);
  EXPECT_NEAR(display.torque({{}, {10, 0}, true}, {0.02, true})[0], -0.2, 1e-12);
}

TEST(ForceDisplay, NeverGivesMoreEnergyThanItGotWhilePassivityIsOn) {
  // A wall felt late: the worst case for a display. The port's energy is summed here, independently of the observer.
  for (const bool passivity : {false, true}) {
    ForceDisplay display{period_s};
    double received_j = 0, lowest_j = 0;
    for (int k = 0; k < 40'000; ++k) {
      const double t = k * period_s;
      const double rate = 0.5 * std::cos(20 * t);
      const double late_position = 0.025 * std::sin(20 * (t - 0.01));
      const Axes torque =
          display.torque({{rate, 0}, {late_position > 0 ? 800 * late_position : 0, 0}, true}, {0.02, passivity});
      received_j -= torque[0] * rate * period_s;
      lowest_j = std::min(lowest_j, received_j);
    }
    if (passivity) {
      EXPECT_GT(lowest_j, -1e-4);
      EXPECT_GT(display.dissipated_j(), 0.001);
    } else {
      EXPECT_LT(lowest_j, -0.01) << "the case must be one that needs the controller";
    }
  }
}

TEST(ForceDisplay, ForgetsItsPastOnReset) {
  ForceDisplay display{period_s};
  (void)display.torque({{5, 0}, {-20, 0}, true}, {0.02, true});
  EXPECT_GT(display.dissipated_j(), 0);
  display.reset();
  EXPECT_EQ(display.dissipated_j(), 0);
  EXPECT_EQ(display.torque({}, {}), (Axes{0, 0}));
}

}  // namespace
}  // namespace hirosco::joystick
