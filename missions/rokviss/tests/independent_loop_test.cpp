// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// The coupled loop written a second time: first held against closed forms, then missions/rokviss/expected.csv against it.
#include "missions/rokviss/independent/coupled_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/figures/expected.hpp"

namespace hirosco::independent {
namespace {

const simulation::Expected& row(const std::string& name) {
  static const auto table = simulation::ExpectedTable::read(HIROSCO_SOURCE_DIR "/missions/rokviss/expected.csv");
  static const simulation::Expected none{};
  const auto* found = table ? table->find(name) : nullptr;
  EXPECT_NE(found, nullptr) << name;
  return found != nullptr ? *found : none;
}

Conditions pressing(double dx_m, double span_s) { return {.offset_m = {dx_m, 0}, .hand_span_s = span_s}; }

TEST(IndependentLoop, RestsOnTheRailWhereTheClosedFormSays) {
  for (const double dx_mm : {17.6, 22.6, 27.6}) {
    Conditions conditions = pressing(dx_mm * 1e-3, 1);
    conditions.friction = Friction::Off;
    conditions.span_s = 6;
    const Sample end = fly(conditions).back();
    const std::string name = fmt::format("RO2-{:.1f}mm-", dx_mm);
    EXPECT_TRUE(row(name + "force").holds(end.force_n)) << end.force_n;
    EXPECT_TRUE(row(name + "penetration").holds(end.penetration_m * 1e3)) << end.penetration_m;
    EXPECT_TRUE(row(name + "tau2").holds(end.torque_n_m[1])) << end.torque_n_m[1];
    EXPECT_TRUE(row(name + "windup2").holds((end.motor_rad[1] - end.link_rad[1]) * 1e3));
  }
}

TEST(IndependentLoop, RestsOnTheRailWithTheForceOfTheSeriesOfItsSprings) {
  Conditions conditions = pressing(0.0226, 1);
  conditions.force_scale = 0;
  conditions.friction = Friction::Off;
  conditions.span_s = 6;
  const Sample end = fly(conditions).back();
  const double one = end.asked_rad[0], two = one + end.asked_rad[1];
  const double x = 0.25 * std::cos(one) + 0.22 * std::cos(two), y = 0.25 * std::sin(one) + 0.22 * std::sin(two);
  EXPECT_NEAR(resting_force_n(y, x + 0.010 - 0.350, 300), end.force_n, 1e-3 * end.force_n);
}

TEST(IndependentLoop, HangsOnASpringAsTheClosedFormSays) {
  Conditions conditions = pressing(0, 1);
  conditions.friction = Friction::Off;
  conditions.span_s = 8;
  conditions.spring = Spring{.anchor_m = {0.280, -0.0215}};
  conditions.legs = {{0, {0.008, -0.030}, 1}};
  const Sample end = fly(conditions).back();
  EXPECT_TRUE(row("RO4-horizontal-tau1").holds(end.torque_n_m[0])) << end.torque_n_m[0];
  EXPECT_TRUE(row("RO4-horizontal-tau2").holds(end.torque_n_m[1])) << end.torque_n_m[1];
}

TEST(IndependentLoop, BouncesInHardContactWithoutPassivityAndRestsWithIt) {
  Conditions conditions = pressing(0.0325, 1);
  conditions.force_scale = 0.08;
  conditions.span_s = 6;
  const auto lost = [](const std::vector<Sample>& flight) {
    const auto away = [](const Sample& sample) { return sample.time_s > 4 && sample.force_n <= 0; };
    return static_cast<double>(std::ranges::count_if(flight, away)) / 4000;
  };
  const auto peak = [](const std::vector<Sample>& flight) {
    return std::ranges::max(flight, {}, &Sample::force_n).force_n;
  };
  const auto without = fly(conditions);
  conditions.passivity = Passivity::On;
  const auto with = fly(conditions);
  EXPECT_TRUE(row("RO6-off-lost").holds(lost(without)));
  EXPECT_TRUE(row("RO6-off-peak").holds(peak(without)));
  EXPECT_TRUE(row("RO6-on-lost").holds(lost(with)));
  EXPECT_TRUE(row("RO6-on-peak").holds(peak(with))) << peak(with);
  EXPECT_TRUE(row("RO6-on-steady").holds(with.back().force_n)) << with.back().force_n;
}

/// Over all delays that the relay of the craft may add to the ground link: its phase and its own cycle each way.
struct Band {
  double low{HUGE_VAL}, high{-HUGE_VAL};
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

TEST(IndependentLoop, IsWhereTheTableHasTheFiguresOfTheGroundLinkFrom) {
  Conditions undelayed = pressing(0.0226, 3);
  undelayed.ticks_per_handle_cycle = 4;
  const double reference_n = figures_of(fly(undelayed)).end_force_n;
  std::cout << fmt::format("  without delay: force {:.2f} N\n", reference_n);
  for (const int round_trip_ms : {20, 30, 60}) {
    std::array<Band, 2> bands;
    for (int relay_ticks = 0; relay_ticks <= 4; ++relay_ticks) {
      Conditions conditions = pressing(0.0226, 3);
      conditions.ticks_per_handle_cycle = 4;
      conditions.up_ticks = conditions.down_ticks = round_trip_ms + relay_ticks;  // of 0.5 ms, each way
      const Figures off = figures_of(fly(conditions));
      conditions.passivity = Passivity::On;
      const Figures on = figures_of(fly(conditions));
      std::cout << fmt::format(
          "  {} ms and {} ms each way: lost {:.2f} %, with passivity {:.2f} %, peak {:.3f} N m, "
          "force {:.2f} N\n",
          round_trip_ms, relay_ticks / 2.0, 100 * off.lost_share, 100 * on.lost_share, on.peak_n_m, on.end_force_n);
      bands[0].add(off.lost_share);
      bands[1].add(on.peak_n_m);
      EXPECT_EQ(on.lost_share, 0);
      EXPECT_TRUE(row(fmt::format("RO7-{}ms-on-force", round_trip_ms)).holds(on.end_force_n));
    }
    constexpr double share_of_a_bounce = 0.01, least_of_a_peak = 0.01, printed_digits = 1.01;
    const auto judge = [&](const char* what, const Band& band, double least) {
      const auto& found = row(fmt::format("RO7-{}ms-{}", round_trip_ms, what));
      const double middle = (band.low + band.high) / 2, half = (band.high - band.low) / 2;
      EXPECT_NEAR(found.value, middle, 0.002 * middle) << found.name;
      EXPECT_LE(found.tolerance, printed_digits * std::max(half, least)) << found.name << " is wider than the runs";
    };
    judge("off-lost", bands[0], share_of_a_bounce);
    judge("on-peak", bands[1], least_of_a_peak * (bands[1].low + bands[1].high) / 2);
    const auto& force = row(fmt::format("RO7-{}ms-on-force", round_trip_ms));
    EXPECT_NEAR(force.value, reference_n, 0.005);
    EXPECT_LE(force.tolerance, printed_digits * 0.01 * force.value);
  }
}

TEST(IndependentLoop, DoesNotHoldWithAHandWhoseTimeIsAQuarterTooFast) {
  Conditions fast = pressing(0.0226, 3);
  fast.ticks_per_handle_cycle = 4;
  fast.up_ticks = fast.down_ticks = 33;
  fast.hand_span_s = 3 / 1.25;
  fast.passivity = Passivity::On;
  EXPECT_FALSE(row("RO7-30ms-on-peak").holds(figures_of(fly(fast)).peak_n_m));
}

}  // namespace
}  // namespace hirosco::independent
