// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "hirosco/pus/packet/failure_code.hpp"
#include "simulation/spacecraft/observed_flight.hpp"

/// Scripts on virtual time: the player is judged like everybody who asks.
namespace hirosco {
namespace {

struct Scripted : ::testing::Test {
  std::optional<simulation::Flight> flown;

  void SetUp() override {
    flown.emplace(simulation::Plan{
        .mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "subsystems/script_player/tests/mission.xml",
        .subsystems = {},
        .devices = {}});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  simulation::CommandOutcome play(const char* script, Duration limit = 20s) {
    return flown->craft().command("PLAYER", "PLAY", {std::string{script}}, limit);
  }
  /// Telecommands to HELLO that the log has of the player, each once, whatever became of it.
  std::size_t moves_of_the_player() {
    std::set<std::uint32_t> found;
    for (const auto& record : flown->records()) {
      const auto telecommand = pus::TelecommandView::parse(record.packet);
      if (telecommand && telecommand->apid() == 7 && telecommand->service() == 8 && telecommand->source() == 25)
        found.insert(pus::read_primary_header(record.packet)->request_id);
    }
    return found.size();
  }
};

TEST_F(Scripted, ThereAndBackEndsWithItsTelecommandAndEachMoveIsInTheLog) {
  const auto outcome = play("THERE_AND_BACK");
  EXPECT_TRUE(outcome.completed) << flown->story().text();
  EXPECT_TRUE(flown->story().missing_in_order({"PLAYER info SCRIPT_BEGUN", "PLAYER info SCRIPT_ENDED"}).empty())
      << flown->story().text();
  EXPECT_EQ(moves_of_the_player(), 2U);
}

TEST_F(Scripted, WhatIsRefusedHalfWayEndsItAndTheThirdIsNeverSent) {
  const auto outcome = play("TOO_FAR");
  EXPECT_FALSE(outcome.completed);
  EXPECT_TRUE(flown->story().has("PLAYER low SCRIPT_STOPPED LINE=6")) << flown->story().text();
  EXPECT_EQ(moves_of_the_player(), 2U);
}

TEST_F(Scripted, AModeThatPermitsNothingToTheGroundPermitsNothingToAScript) {
  ASSERT_TRUE(flown->enter_mode("quiet").completed) << flown->story().text();
  EXPECT_FALSE(play("TOO_FAR").completed);
  EXPECT_TRUE(flown->story().has("PLAYER low SCRIPT_STOPPED LINE=5")) << flown->story().text();
}

}  // namespace
}  // namespace hirosco
