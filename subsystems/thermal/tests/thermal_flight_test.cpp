// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hirosco/pus/packet/failure_code.hpp"
#include "simulation/spacecraft/observed_flight.hpp"

/// The mission of this folder on virtual time, judged by what its world tells.
namespace hirosco {
namespace {

struct ThermalFlight : ::testing::Test {
  std::optional<simulation::Flight> flown;

  void SetUp() override {
    flown.emplace(
        simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "subsystems/thermal/tests/mission.xml",
                         .subsystems = {},
                         .devices = {}});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  void does(const std::string& line) { ASSERT_TRUE(flown->craft().device("thermal")->fault(line)) << line; }
  double truth(const std::string& name) {
    const std::string words = " " + flown->craft().device("thermal")->truth();
    const auto at = words.find(" " + name + "=");
    return at == words.npos ? NAN : std::atof(words.c_str() + at + name.size() + 2);
  }
  simulation::CommandOutcome ask(std::string_view function, const std::vector<Value>& arguments) {
    return flown->craft().command("THERMAL", function, arguments, 5s);
  }
  static std::uint16_t code(const simulation::CommandOutcome& outcome) {
    return static_cast<std::uint16_t>(outcome.failure.value_or(pus::FailureCode{}));
  }
  void run(double s) { flown->craft().run(Duration{std::llround(s * 1e9)}); }
};

TEST_F(ThermalFlight, EachZoneIsAtItsSetPointInTheWorldAndTheCraftIsToldSo) {
  ASSERT_TRUE(ask("SET_POINT", {0, 25}).completed);
  ASSERT_TRUE(ask("SET_POINT", {11, 12}).completed);
  double most_w = 0;
  for (int i = 0; i < 400; ++i) {
    run(0.1);
    most_w = std::max(most_w, truth("drawn_w"));
  }
  EXPECT_NEAR(truth("t0"), 25, 0.5);
  EXPECT_NEAR(truth("t6"), 18, 0.5);
  EXPECT_NEAR(truth("t11"), 12, 0.5);
  EXPECT_LE(most_w, 60);
  EXPECT_GE(flown->story().count("SET_POINT_REACHED"), 11U) << flown->story().text();
  EXPECT_EQ(code(ask("SET_POINT", {0, 60})), 0x8001);
  EXPECT_EQ(code(ask("SET_POINT", {0, -60})), 0x8002);
}

/// In the dark, with more zones than power: what keeps nothing from breaking goes to who is coldest, whatever the rank.
TEST_F(ThermalFlight, WhereThePowerDoesNotSufficeNobodyBreaks) {
  does("eclipse on");
  does("inside_w 1");
  double coldest_c = 100, most_w = 0;
  for (int i = 0; i < 1200; ++i) {
    run(0.1);
    most_w = std::max(most_w, truth("drawn_w"));
    for (int zone = 0; zone < 12; ++zone) coldest_c = std::min(coldest_c, truth(fmt::format("t{}", zone)));
  }
  EXPECT_LE(most_w, 60);
  EXPECT_GT(coldest_c, -13);
  EXPECT_LT(truth("t11"), 15) << "the last in rank gave way";
  EXPECT_TRUE(flown->story().has("POWER_SHORT")) << flown->story().text();
}

TEST_F(ThermalFlight, SurvivalIsAModeThatKeepsNoMoreThanItMust) {
  ASSERT_TRUE(flown->set_mode("survival").completed) << flown->story().text();
  does("eclipse on");
  double most_w = 0;
  for (int i = 0; i < 1200; ++i) {
    run(0.1);
    if (i > 600) most_w = std::max(most_w, truth("drawn_w"));
  }
  EXPECT_LE(most_w, 30);
  EXPECT_GT(most_w, 0);
  for (int zone = 0; zone < 12; ++zone) EXPECT_NEAR(truth(fmt::format("t{}", zone)), -10, 3) << zone;
}

TEST_F(ThermalFlight, ASwitchThatDoesNotOpenIsCutOutBeforeAnythingBreaks) {
  does("heater 5 stuck_on");
  double hottest_c = 0;
  for (int i = 0; i < 300; ++i) {
    run(0.1);
    hottest_c = std::max(hottest_c, truth("t5"));
  }
  EXPECT_EQ(flown->story().count("OVER_TEMPERATURE"), 1U) << flown->story().text();
  EXPECT_EQ(truth("line5"), 0);
  EXPECT_LT(hottest_c, 60);
  std::cout << fmt::format("  hottest {:.1f} degC, 45 is the limit\n", hottest_c);
  does("heater 5 well");
  EXPECT_TRUE(ask("CLOSE_LINE", {5}).completed);
  flown->craft().kill("THERMAL");
  run(1.5);
  EXPECT_TRUE(flown->story().has("died"));
}

TEST_F(ThermalFlight, AStopOfEverythingLeavesTheCraftItsHeat) {
  static_cast<void>(flown->craft().command("SUPERVISOR", "SAFE_ALL", {}, 5s));
  does("eclipse on");
  run(120);
  EXPECT_EQ(flown->state("THERMAL"), State::SafeOperational) << flown->story().text();
  EXPECT_EQ(truth("own"), 0);
  for (int zone = 0; zone < 12; ++zone) EXPECT_NEAR(truth(fmt::format("t{}", zone)), -10, 3) << zone;
}

/// The control is gone, and its unit keeps the zones by itself until it is there again.
TEST_F(ThermalFlight, TheUnitKeepsTheZonesWhileItsControlIsDead) {
  does("unplug");
  does("temperatures -20");
  run(3);
  EXPECT_EQ(truth("own"), 1);
  EXPECT_GE(truth("drawn_w"), 110) << "its thermostats know no power";
}

TEST_F(ThermalFlight, FliesTheSameTemperaturesFromTheSameSeed) {
  run(5);
  const double first_c = truth("t3");
  SetUp();
  run(5);
  EXPECT_EQ(truth("t3"), first_c);
}

}  // namespace
}  // namespace hirosco
