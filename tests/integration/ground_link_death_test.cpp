// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// The process of the ground link dies in a mission whose plans restart nobody (docs/adr/0165).
#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

struct GroundLinkDeath : ::testing::Test {
  Flight flight{{.mission = "hello"}};
  void SetUp() override { ASSERT_TRUE(flight.commission()) << flight.story().text(); }
  /// A telecommand is under way and has come so far that this is told.
  [[nodiscard]] bool begins(std::string_view function, const std::vector<Value>& arguments, std::string_view line) {
    static_cast<void>(flight.craft().command("SUPERVISOR", function, arguments, 1ms));
    for (int step = 0; step < 50 && !flight.story().has(line); ++step) flight.craft().run(1ms);
    return flight.story().has(line);
  }
  [[nodiscard]] bool comes_back(Duration within) {
    return flight.run_until_state("COMMUNICATION", State::Operational, within);
  }
};

TEST_F(GroundLinkDeath, IsFollowedByAStartAndTheGroundCommandsAgain) {
  flight.craft().kill("COMMUNICATION");
  ASSERT_TRUE(comes_back(2s)) << flight.story().text();
  EXPECT_TRUE(flight.craft().command("HELLO", "SET_STATE", {static_cast<double>(State::SafeOperational)}).completed);
}

TEST_F(GroundLinkDeath, AgainAndAgainIsFollowedByAStartAgainAndAgain) {
  for (int death = 1; death <= 10; ++death) {
    flight.craft().kill("COMMUNICATION");
    ASSERT_TRUE(comes_back(12s)) << death << flight.story().text();
    EXPECT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed) << death;
  }
}

TEST_F(GroundLinkDeath, InAStopOfEverythingLeavesItStoppedAndComesBack) {
  ASSERT_TRUE(begins("SAFE_ALL", {}, "SAFE_ALL: every actuator inhibited")) << flight.story().text();
  flight.craft().kill("COMMUNICATION");
  ASSERT_TRUE(comes_back(2s)) << flight.story().text();
  EXPECT_EQ(flight.state("HELLO"), State::SafeOperational);
  EXPECT_TRUE(flight.story().has("everything has stopped")) << flight.story().text();
  EXPECT_TRUE(flight.set_state("HELLO", State::Operational).completed) << "ground lets it go again";
}

TEST_F(GroundLinkDeath, InAChangeOfModeEndsItAndTheGroundChangesTheModeAgain) {
  ASSERT_TRUE(flight.set_state("HELLO", State::SafeOperational).completed);
  const auto operation = static_cast<double>(flight.mission().find_mode("operation")->id);
  ASSERT_TRUE(begins("SET_MODE", {operation}, "change from mode operation to operation")) << flight.story().text();
  flight.craft().kill("COMMUNICATION");
  ASSERT_TRUE(comes_back(2s)) << flight.story().text();
  EXPECT_TRUE(flight.story().has("the change to mode operation stopped: plan default because of COMMUNICATION"))
      << flight.story().text();
  EXPECT_TRUE(flight.set_mode("operation").completed) << flight.story().text();
  EXPECT_EQ(flight.state("HELLO"), State::Operational);
}

/// Its station is gone when the ground link dies, or at the same time; HELLO comes to rest by the mission's plan for the loss of the ground.
struct GroundLossByDeath : ::testing::Test {
  Flight flight{{.mission = "hello", .edit = [](descriptor::Mission& mission) {
                   const auto rest = static_cast<std::int64_t>(State::SafeOperational);
                   mission.plans.front().steps = {{"set_state", {rest}, "HELLO"}};
                 }}};
  void SetUp() override { ASSERT_TRUE(flight.commission()) << flight.story().text(); }
  static constexpr const char* told = "SUPERVISOR medium GROUND_LINK_LOST APID=2";
};

TEST_F(GroundLossByDeath, IsToldByTheSupervisorWhereNobodyComesBack) {
  flight.craft().kill("COMMUNICATION");
  flight.craft().ground().is_there(false);
  flight.craft().run(1900ms);
  EXPECT_EQ(flight.state("COMMUNICATION"), State::Operational) << "it is back";
  EXPECT_EQ(flight.state("HELLO"), State::Operational);
  ASSERT_TRUE(flight.run_until_state("HELLO", State::SafeOperational, 300ms)) << flight.story().text();
  EXPECT_EQ(flight.story().count(told), 1U);
  EXPECT_FALSE(flight.story().has("COMMUNICATION medium GROUND_LINK_LOST")) << "who is new has never had anybody";
  flight.craft().run(10s);
  EXPECT_EQ(flight.story().count(told), 1U) << "once";
  flight.craft().ground().is_there(true);
  flight.craft().run(100ms);
  EXPECT_TRUE(flight.set_state("HELLO", State::Operational).completed) << flight.story().text();
}

TEST_F(GroundLossByDeath, IsNoneWhereTheStationConnectsAgain) {
  flight.craft().kill("COMMUNICATION");
  flight.craft().run(10s);
  EXPECT_FALSE(flight.story().has("GROUND_LINK_LOST")) << flight.story().text();
  EXPECT_EQ(flight.state("HELLO"), State::Operational);
}

TEST_F(GroundLossByDeath, IsToldWhereTheGroundLinkStandsStillFirst) {
  flight.craft().stop("COMMUNICATION", true);
  flight.craft().ground().is_there(false);
  ASSERT_TRUE(flight.run_until_state("HELLO", State::SafeOperational, 6s)) << flight.story().text();
  EXPECT_EQ(flight.story().count(told), 1U);
}

TEST_F(GroundLossByDeath, IsToldWhereATelecommandTookItOfflineAndNobodyComesBack) {
  ASSERT_TRUE(flight.set_mode("commissioning").completed);
  for (const State state : {State::SafeOperational, State::PostOperational})
    ASSERT_TRUE(flight.set_state("COMMUNICATION", state).completed) << to_text(state);
  static_cast<void>(flight.craft().command("COMMUNICATION", "SET_STATE", {static_cast<double>(State::Offline)}, 10ms));
  flight.craft().ground().is_there(false);
  ASSERT_TRUE(flight.run_until_state("HELLO", State::SafeOperational, 4s)) << flight.story().text();
  EXPECT_EQ(flight.story().count(told), 1U);
  EXPECT_EQ(flight.state("COMMUNICATION"), State::Operational);
}

}  // namespace
}  // namespace hirosco::testing
