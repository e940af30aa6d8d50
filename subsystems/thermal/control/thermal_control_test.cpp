// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "subsystems/thermal/control/cut_out.hpp"
#include "subsystems/thermal/control/heat_law.hpp"
#include "subsystems/thermal/control/heater_share.hpp"
#include "subsystems/thermal/control/zone_sensor.hpp"

namespace hirosco::thermal {
namespace {

constexpr float dt_s = 0.1F;
constexpr float no_number = std::numeric_limits<float>::quiet_NaN();

TEST(ZoneSensor, IsDoubtedAfterThreeReadingsThatAreNoTemperature) {
  for (const float wrong_c : {-273.15F, 200.0F, no_number}) {
    ZoneSensor sensor;
    EXPECT_EQ(sensor.update(20, dt_s, {}), Doubt::None);
    EXPECT_EQ(sensor.update(wrong_c, dt_s, {}), Doubt::None);
    EXPECT_EQ(sensor.update(wrong_c, dt_s, {}), Doubt::None);
    EXPECT_TRUE(sensor.good());
    EXPECT_EQ(sensor.update(wrong_c, dt_s, {}), Doubt::NoTemperature);
    EXPECT_FALSE(sensor.good());
    EXPECT_EQ(sensor.update(wrong_c, dt_s, {}), Doubt::None) << "told once";
    EXPECT_EQ(sensor.update(20, dt_s, {}), Doubt::None);
    EXPECT_FALSE(sensor.good()) << "until somebody trusts it";
    EXPECT_FALSE(sensor.trust(wrong_c, {}));
    EXPECT_TRUE(sensor.trust(19, {}));
    EXPECT_TRUE(sensor.good());
    EXPECT_EQ(sensor.temperature_c(), 19);
  }
}

TEST(ZoneSensor, OneDamagedReadingIsPassedOver) {
  ZoneSensor sensor;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(sensor.update(20, dt_s, {}), Doubt::None);
    EXPECT_EQ(sensor.update(90, dt_s, {}), Doubt::None);
    EXPECT_EQ(sensor.temperature_c(), 20);
  }
}

TEST(ZoneSensor, IsDoubtedWhereItGoesFasterThanAZoneCan) {
  const SensorLimits limits{.rate_k_s = 1};
  ZoneSensor slow, jumping;
  float t_c = 20;
  static_cast<void>(jumping.update(t_c, dt_s, limits));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(slow.update(t_c += 0.1F, dt_s, limits), Doubt::None);
  EXPECT_EQ(jumping.update(25, dt_s, limits), Doubt::None);
  EXPECT_EQ(jumping.update(25, dt_s, limits), Doubt::None);
  EXPECT_EQ(jumping.update(25, dt_s, limits), Doubt::Jumped);
  // Who was not heard for a while may have gone far.
  ZoneSensor late;
  static_cast<void>(late.update(20, dt_s, limits));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(late.update(25, 5, limits), Doubt::None);
  EXPECT_EQ(late.temperature_c(), 25);
}

TEST(ZoneSensor, IsStuckWhereItSaysTheSameToTheLastBitForTooLong) {
  const SensorLimits limits{.stuck_s = 2};
  ZoneSensor stuck, quiet;
  int told = 0;
  for (int i = 0; i < 40; ++i) {
    if (stuck.update(20, dt_s, limits) == Doubt::Stuck) ++told;
    EXPECT_EQ(quiet.update(20 + (i % 2 == 0 ? 0.001F : 0), dt_s, limits), Doubt::None);
  }
  EXPECT_EQ(told, 1);
  ZoneSensor never;
  for (int i = 0; i < 40; ++i) EXPECT_EQ(never.update(20, dt_s, {}), Doubt::None) << "not asked";
}

TEST(CutOut, OpensAfterThreeReadingsAboveItsLimitAndStaysOpen) {
  CutOut cut_out;
  EXPECT_FALSE(cut_out.update(46, 45, {}));
  EXPECT_FALSE(cut_out.update(46, 45, {}));
  EXPECT_FALSE(cut_out.update(45, 45, {})) << "that begins anew";
  EXPECT_FALSE(cut_out.update(46, 45, {}));
  EXPECT_FALSE(cut_out.update(46, 45, {}));
  EXPECT_TRUE(cut_out.update(46, 45, {}));
  EXPECT_FALSE(cut_out.update(20, 45, {}));
  EXPECT_TRUE(cut_out.open());
  EXPECT_FALSE(cut_out.close(41, 45, {})) << "not cooled";
  EXPECT_TRUE(cut_out.close(39, 45, {}));
  EXPECT_FALSE(cut_out.open());
}

TEST(CutOut, WhatIsNoTemperatureSaysNothing) {
  CutOut cut_out;
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(cut_out.update(i % 2 == 0 ? 200 : no_number, 45, {}));
}

TEST(HeatLaw, TheThermostatSwitchesAtBothEndsOfItsHysteresis) {
  HeatLaw law;
  const LawValues values{.hysteresis_k = 2};
  EXPECT_EQ(law.thermostat(0.9F, values), 0);
  EXPECT_EQ(law.thermostat(1.1F, values), 1);
  EXPECT_EQ(law.thermostat(-0.9F, values), 1);
  EXPECT_EQ(law.thermostat(-1.1F, values), 0);
  EXPECT_EQ(law.thermostat(0.9F, values), 0);
}

/// C dT/dt = share P - G (T - T_sink): the integral finds the share that holds it, G (T - T_sink) / P, without a remaining error.
TEST(HeatLaw, TheIntegralFindsTheShareThatHoldsAZone) {
  HeatLaw law;
  const LawValues values{.gain_per_k = 0.1F, .reset_s = 600};
  constexpr double capacity_j_k = 500, w_k = 0.2, heater_w = 10, sink_c = -10, set_c = 20;
  double t_c = 0;
  float share = 0;
  for (int i = 0; i < 200'000; ++i) {
    share = law.proportional(static_cast<float>(set_c - t_c), dt_s, HeatLaw::Given::All, values);
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    t_c += double{dt_s} * (double{share} * heater_w - w_k * (t_c - sink_c)) / capacity_j_k;
    ASSERT_LT(t_c, set_c + 5) << "overshoot";
  }
  EXPECT_NEAR(t_c, set_c, 0.01);
  EXPECT_NEAR(share, w_k * (set_c - sink_c) / heater_w, 0.005);
}

TEST(HeatLaw, WhatIsNotGivenIsNotCaughtUpWith) {
  HeatLaw law;
  const LawValues values{.gain_per_k = 0.01F, .reset_s = 10};
  for (int i = 0; i < 1000; ++i) static_cast<void>(law.proportional(20, dt_s, HeatLaw::Given::Less, values));
  EXPECT_LT(law.proportional(-20, dt_s, HeatLaw::Given::All, values), 0.01F) << "off as soon as it is too warm";
}

/// Ten cycles of each share: as many of them on.
TEST(HeaterShare, EachIsOnForItsShareOfTheTime) {
  HeaterShare heaters;
  const std::array wanted{Wanted{.share = 0.1F, .heater_w = 10}, Wanted{.share = 0.35F, .heater_w = 10},
                          Wanted{.share = 1, .heater_w = 10}, Wanted{.share = 0, .heater_w = 10}};
  std::array<int, 4> cycles{};
  for (int i = 0; i < 1000; ++i) {
    std::array<std::uint8_t, 4> on{};
    heaters.share(wanted, 100, on);
    for (std::size_t zone = 0; zone < on.size(); ++zone) cycles[zone] += on[zone];
  }
  EXPECT_NEAR(cycles[0], 100, 1);
  EXPECT_NEAR(cycles[1], 350, 1);
  EXPECT_EQ(cycles[2], 1000);
  EXPECT_EQ(cycles[3], 0);
}

TEST(HeaterShare, NeverDrawsMoreThanThereIsAndTheFirstInRankHaveTheirs) {
  HeaterShare heaters;
  std::array<Wanted, most_zones> wanted{};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    wanted[i] = {.share = 0.8F, .heater_w = 10, .rank = static_cast<std::uint8_t>(wanted.size() - i)};
  std::array<int, most_zones> cycles{};
  for (int i = 0; i < 1000; ++i) {
    std::array<std::uint8_t, most_zones> on{};
    heaters.share(wanted, 60, on);
    ASSERT_LE(heaters.drawn_w(), 60);
    for (std::size_t zone = 0; zone < on.size(); ++zone) cycles[zone] += on[zone];
  }
  for (std::size_t zone = 6; zone < most_zones; ++zone) {
    EXPECT_NEAR(cycles[zone], 800, 1) << zone;
    EXPECT_FALSE(heaters.is_short(zone)) << zone;
  }
  for (std::size_t zone = 0; zone < 6; ++zone) {
    EXPECT_NEAR(cycles[zone], 200, 2) << "what those leave";
    EXPECT_TRUE(heaters.is_short(zone)) << zone;
  }
}

TEST(HeaterShare, WhoIsUrgentComesBeforeEveryRank) {
  HeaterShare heaters;
  const std::array wanted{Wanted{.share = 1, .heater_w = 10, .rank = 0},
                          Wanted{.share = 1, .heater_w = 10, .rank = 9, .urgent = true}};
  std::array<std::uint8_t, 2> on{};
  heaters.share(wanted, 10, on);
  EXPECT_EQ(on, (std::array<std::uint8_t, 2>{0, 1}));
}

TEST(DrawnWatch, TellsOnceThatMoreIsDrawnThanCommandedAndHowMuch) {
  DrawnWatch watch;
  EXPECT_FALSE(watch.update(20, 20.5F));
  EXPECT_FALSE(watch.update(20, 30));
  EXPECT_FALSE(watch.update(30, 41));
  EXPECT_EQ(watch.excess_w(), 0);
  EXPECT_TRUE(watch.update(10, 20));
  EXPECT_EQ(watch.excess_w(), 10);
  EXPECT_FALSE(watch.update(10, 20));
  EXPECT_FALSE(watch.update(10, 10));
  EXPECT_EQ(watch.excess_w(), 0);
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(watch.update(20, 10));
  EXPECT_TRUE(watch.update(20, 10)) << "one that is burnt out";
  EXPECT_EQ(watch.excess_w(), 0);
}

}  // namespace
}  // namespace hirosco::thermal
