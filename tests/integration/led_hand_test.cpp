// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What a visitor does to the handle with a mouse, against the manipulator's torque limit of 12 N m: as a bound that less 15 %.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hirosco/utilities/testing/slice.hpp"
#include "simulation/devices/joystick/joystick_device.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using simulation::JoystickDevice;
using simulation::RobotDevice;
using simulation::Vec2;
using simulation::operator*;

constexpr double limit_n_m = 12, with_margin_n_m = 0.85 * limit_n_m;
constexpr double range_rad = 0.4;
constexpr Duration mouse_period = 20ms;

struct LedHand : ::testing::Test {
  void SetUp() override {
    ASSERT_TRUE(flight.commission()) << flight.story().text();
    flight.craft().on_cycle([this](std::string_view subsystem, TimePoint) {
      if (subsystem != "JOYSTICK") return;
      const Vec2 torque = robot().arm().joint_torque_n_m();
      peak_n_m = std::max({peak_n_m, std::abs(torque[0]), std::abs(torque[1])});
    });
  }
  [[nodiscard]] RobotDevice& robot() { return flight.device<RobotDevice>("robot"); }
  [[nodiscard]] JoystickDevice& joystick() { return flight.device<JoystickDevice>("joystick"); }
  void to(const Vec2& target) {
    ASSERT_TRUE(joystick().hand(fmt::format("target {:.5f} {:.5f}", target[0], target[1])));
  }
  /// A target each 20 ms, as a fast mouse tells them.
  void lead(Duration span, const std::function<Vec2(double)>& target) {
    for (Duration past{}; past < span; past += mouse_period) {
      to(target(seconds(past)));
      flight.craft().run(mouse_period);
    }
  }
  void calm(const std::string& what) {
    EXPECT_LT(peak_n_m, with_margin_n_m) << what;
    EXPECT_EQ(flight.state("MANIPULATOR"), State::Operational) << what;
    EXPECT_EQ(flight.inhibited("MANIPULATOR"), 0U) << what;
    worst_n_m = std::max(worst_n_m, peak_n_m);
    peak_n_m = 0;
  }
  void home() {
    to({0, 0});
    flight.craft().run(3s);
  }

  void TearDown() override { RecordProperty("largest_torque_n_m", fmt::format("{:.2f}", worst_n_m)); }

  Flight flight{{.edit = hand_rests}};
  double peak_n_m{0};
  double worst_n_m{0};
};

TEST_F(LedHand, MayBeShakenAtAnyPaceInAnyDirection) {
  int turn = 0;
  for (const double hz : {0.3, 0.5, 0.8, 1.2, 2.0, 3.3, 5.0, 8.0})
    for (const Vec2& way : {Vec2{1, 0}, Vec2{0, 1}, Vec2{1, 1}, Vec2{1, -1}}) {
      if (++turn % one_in(3) != 0) continue;
      lead(4s, [&](double t) {
        const double sign = std::sin(2 * std::numbers::pi * hz * t) >= 0 ? 1 : -1;
        return sign * range_rad * way;
      });
      calm(fmt::format("shaken at {} Hz along {} {}", hz, way[0], way[1]));
      home();
      peak_n_m = 0;
    }
}

TEST_F(LedHand, MayLeapAnywhereAtAnyTime) {
  std::mt19937 random{8};
  std::uniform_real_distribution<double> anywhere{-range_rad, range_rad};
  for (const double each_s : {0.02, 0.06, 0.2, 0.5, 1.0, 2.0}) {
    Vec2 target{};
    double next_s = 0;
    lead(40s / one_in(2), [&](double t) {
      if (t >= next_s) {
        target = {anywhere(random), anywhere(random)};
        next_s += each_s;
      }
      return target;
    });
    calm(fmt::format("leaps each {} s", each_s));
  }
}

TEST_F(LedHand, MayPushTheRailAndRubAlongIt) {
  for (const double q1 : {-0.4, -0.2, 0.0, 0.2, 0.4}) {
    to({q1, 0.2});
    flight.craft().run(2s);
    calm("before");
    to({q1, -0.4});  // bends the elbow open: into the rail
    flight.craft().run(2s);
    calm(fmt::format("pushed at {}", q1));
    lead(6s, [&](double t) { return Vec2{q1 * std::cos(3 * t), -0.4}; });
    calm(fmt::format("rubbed from {}", q1));
    lead(4s, [&](double t) { return Vec2{0.4 * std::sin(9 * t), -0.4}; });
    calm(fmt::format("rubbed fast from {}", q1));
  }
}

TEST_F(LedHand, MayBeGrabbedAgainAfterTheClutchWasEngagedElsewhere) {
  std::mt19937 random{9};
  std::uniform_real_distribution<double> anywhere{-range_rad, range_rad};
  for (int k = 0; k < 10; ++k) {
    ASSERT_TRUE(flight.set_state("JOYSTICK", State::SafeOperational).completed);
    to({anywhere(random), anywhere(random)});
    flight.craft().run(2s);
    ASSERT_TRUE(flight.set_state("JOYSTICK", State::Operational).completed);
    for (int push = 0; push < 4; ++push) {
      to({anywhere(random), push % 2 == 0 ? -0.4 : 0.4});
      flight.craft().run(2s);
    }
    calm(fmt::format("clutch {}", k));
  }
}

TEST_F(LedHand, OfItsOwnMindGivesWayTooAfterTheClutchWasEngagedElsewhere) {
  std::mt19937 random{10};
  std::uniform_real_distribution<double> anywhere{-0.15, 0.15};
  for (int k = 0; k < 6; ++k) {
    ASSERT_TRUE(flight.set_state("JOYSTICK", State::SafeOperational).completed);
    to({anywhere(random), anywhere(random)});
    flight.craft().run(2s);
    ASSERT_TRUE(flight.set_state("JOYSTICK", State::Operational).completed);
    ASSERT_TRUE(joystick().hand("wander"));
    flight.craft().run(12s);
    calm(fmt::format("wandering {}", k));
  }
}

TEST_F(LedHand, IsNeededBecauseAHandThatPressesOnTripsTheLimit) {
  ASSERT_TRUE(joystick().hand("ramp 0.065 0 0.04"));
  flight.craft().run(2s);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::SafeOperational);
}

TEST_F(LedHand, PressesOnLongEnoughToBeFelt) {
  to({0, -0.4});
  flight.craft().run(4s);
  // At the rail 12.55 mm before home; 0.12 N m of pull are 6 N m at joint 2, 6 / 0.158 m = 38 N there.
  EXPECT_NEAR(robot().arm().contact().normal_force_n, 38, 4);
  EXPECT_NEAR(std::abs(joystick().motor_torque_n_m()[1]), 0.12, 0.012);
  calm("pressed");
}

}  // namespace
}  // namespace hirosco::testing
