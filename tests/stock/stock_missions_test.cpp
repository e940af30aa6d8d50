// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>

#include "simulation/spacecraft/observed_flight.hpp"

/// Ready subsystems in missions that are not theirs, on virtual time and judged by what their worlds tell.
namespace hirosco {
namespace {

struct StockMission : ::testing::Test {
  std::optional<simulation::Flight> flown;

  void fly(const char* mission) {
    flown.emplace(simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "tests/stock" / mission});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  void does(const char* device, const std::string& line) {
    const auto taken = flown->craft().device(device)->fault(line);
    ASSERT_TRUE(taken) << line << ": " << taken.error().text;
  }
  [[nodiscard]] double truth(const char* device, const std::string& name) {
    const std::string words = " " + flown->craft().device(device)->truth();
    const auto at = words.find(" " + name + "=");
    return at == words.npos ? NAN : std::atof(words.c_str() + at + name.size() + 2);
  }
  [[nodiscard]] std::uint32_t configuration(std::string_view subsystem) {
    return flown->craft().vital(subsystem)->configuration.load();
  }
};

struct PlatformMission : StockMission {
  static constexpr std::uint32_t thermal_nominal = 1, thermal_survival = 2;
  void SetUp() override { fly("platform.xml"); }
  [[nodiscard]] double turned_deg() {
    return 2 * std::atan2(truth("base", "qz"), truth("base", "qw")) * 180 / std::numbers::pi;
  }
};

TEST_F(PlatformMission, TurnsToAnAttitudeAndSettlesThereWithItsArmStowed) {
  bool settled = false;
  flown->story().on_line = [&](std::string_view line) {
    settled = settled || line.find("AOCS info ATTITUDE_SETTLED") != line.npos;
  };
  const double half = 0.25 * std::numbers::pi / 180;  // half a degree about z
  ASSERT_TRUE(flown->craft().command("AOCS", "POINT_TO", {std::cos(half), 0.0, 0.0, std::sin(half)}).completed);
  EXPECT_TRUE(flown->craft().run_until([&] { return settled; }, 60s)) << flown->story().text();
  EXPECT_NEAR(turned_deg(), 0.5, 0.1);
  EXPECT_EQ(flown->inhibited("AOCS"), 0U);
  EXPECT_EQ(flown->state("MCS"), State::Offline);
}

TEST_F(PlatformMission, KeepsWhatSurvivesInTheEclipseAndRefusesTheArm) {
  EXPECT_EQ(configuration("THERMAL"), thermal_nominal);
  does("power", "eclipse on");
  flown->craft().run(1s);
  EXPECT_EQ(configuration("THERMAL"), thermal_survival);
  EXPECT_FALSE(flown->set_mode("work").completed);
  EXPECT_TRUE(flown->story().has("MCS needs 260 W")) << flown->story().text();
  EXPECT_EQ(flown->state("AOCS"), State::Operational) << "the station is kept";
  does("power", "eclipse off");
  flown->craft().run(1s);
  EXPECT_EQ(configuration("THERMAL"), thermal_nominal);
  ASSERT_TRUE(flown->set_mode("work").completed) << flown->story().text();
  EXPECT_EQ(flown->state("AOCS"), State::Offline);
  EXPECT_TRUE(
      flown->craft().command("MCS", "MOVE_JOINT", {0.2, 0.75, -0.3, -1.25, -0.05, 1.85, 0.0, 2.0}, 10s).completed)
      << flown->story().text();
  EXPECT_NEAR(truth("arm", "q1"), 0.2, 2e-3);
}

TEST_F(StockMission, AScriptTakesABoxWithArmAndGripperAndPutsItBack) {
  fly("pick.xml");
  const double x_m = truth("arm", "body_box_x"), z_m = truth("arm", "body_box_z");
  double highest_m = z_m;
  flown->craft().on_cycle(
      [&](std::string_view, TimePoint) { highest_m = std::max(highest_m, truth("arm", "body_box_z")); });
  EXPECT_TRUE(flown->craft().command("PLAYER", "PLAY", {std::string{"PICK_AND_PUT_BACK"}}, 60s).completed)
      << flown->story().text();
  EXPECT_GT(highest_m, z_m + 0.05) << "it was carried";
  EXPECT_NEAR(truth("arm", "body_box_x"), x_m, 5e-3);
  EXPECT_NEAR(truth("arm", "body_box_z"), z_m, 5e-3);
  EXPECT_EQ(truth("arm", "body_box_pressed_n"), 0) << "and let go";
}

TEST_F(StockMission, AScriptWhoseBoxIsTakenAwayEndsThereAndTheArmGoesNowhere) {
  fly("pick.xml");
  flown->story().on_line = [&](std::string_view line) {
    if (line.find("OBJECT_HELD") != line.npos) does("arm", "body_box none");
  };
  EXPECT_FALSE(flown->craft().command("PLAYER", "PLAY", {std::string{"PICK_AND_PUT_BACK"}}, 60s).completed);
  EXPECT_TRUE(flown->story().has("PLAYER low SCRIPT_STOPPED")) << flown->story().text();
  EXPECT_TRUE(flown->run_until_state("ARM", State::SafeOperational, 1s)) << flown->story().text();
}

TEST_F(StockMission, TwoRobotsOfTwoFilesStandInOneWorldWhereEachMovesByItsOwnDeviceAndTheyMeet) {
  fly("beside.xml");
  ASSERT_NEAR(truth("gripper", "q1"), 0.02, 2e-3) << flown->story().text();
  ASSERT_TRUE(flown->craft().command("GRIPPER", "MOVE_TO", {0.08, 0.1}, 10s).completed) << flown->story().text();
  EXPECT_NEAR(truth("gripper", "q1"), 0.04, 1e-3) << "half of the width";
  EXPECT_NEAR(truth("arm", "q1"), 0.2, 2e-3) << "which the arm did not notice";
  EXPECT_EQ(truth("arm", "contacts") + truth("gripper", "contacts"), 0);
  double met_n = 0;
  flown->craft().on_cycle([&](std::string_view, TimePoint) { met_n = std::max(met_n, truth("arm", "contact_n")); });
  // Nobody told the arm of what stands there, and its observer finds it out.
  const auto met = flown->craft().command("ARM", "MOVE_J", {-0.8, -0.2, 0.6, 0.5, -0.5, 1.0, 0.2}, 70s);
  EXPECT_EQ(static_cast<std::uint16_t>(met.failure.value()), 0x8004) << flown->story().text();
  EXPECT_GT(met_n, 1);
  flown->craft().run(1s);  // it comes to rest
  const auto away = flown->craft().command("ARM", "MOVE_J", {0.2, 0.5, 1.2, -0.6, 0.7, 0.1, 0.2}, 70s);
  EXPECT_TRUE(away.completed) << "it may go away: " << static_cast<int>(away.failure.value_or(pus::FailureCode{}))
                              << "\n"
                              << flown->story().text();
  EXPECT_EQ(truth("arm", "contacts"), 0);
  EXPECT_TRUE(flown->craft().command("GRIPPER", "OPEN", {0.1}, 10s).completed) << flown->story().text();
}

TEST_F(StockMission, TwoRobotsInOneWorldGiveTheSameOctetsTwice) {
  std::array<std::vector<supervisor::LogRecord>, 2> records;
  for (auto& each : records) {
    fly("beside.xml");
    EXPECT_FALSE(flown->craft().command("ARM", "MOVE_J", {-0.8, -0.2, 0.6, 0.5, -0.5, 1.0, 0.2}, 70s).completed);
    each = flown->records();
  }
  EXPECT_GT(records[0].size(), 50U);
  EXPECT_TRUE(records[0] == records[1]);
}

}  // namespace
}  // namespace hirosco
