// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// The process of the ground link dies in a mission whose plans restart nobody (docs/adr/0165).
#include <gtest/gtest.h>

#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

struct GroundLinkDeath : ::testing::Test {
  Flight flight{{.mission = "hello"}};
  void SetUp() override { ASSERT_TRUE(flight.commission()) << flight.story().text(); }
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
  static_cast<void>(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}, 2ms));
  flight.craft().kill("COMMUNICATION");
  ASSERT_TRUE(comes_back(2s)) << flight.story().text();
  EXPECT_EQ(flight.state("HELLO"), State::SafeOperational);
  EXPECT_TRUE(flight.story().has("everything has stopped")) << flight.story().text();
  EXPECT_TRUE(flight.set_state("HELLO", State::Operational).completed) << "ground lets it go again";
}

TEST_F(GroundLinkDeath, InAChangeOfModeEndsItAndTheGroundChangesTheModeAgain) {
  ASSERT_TRUE(flight.set_state("HELLO", State::SafeOperational).completed);
  const auto operation = static_cast<double>(flight.mission().find_mode("operation")->id);
  static_cast<void>(flight.craft().command("SUPERVISOR", "SET_MODE", {operation}, 5ms));
  ASSERT_TRUE(flight.story().has("change from mode operation to operation")) << flight.story().text();
  flight.craft().kill("COMMUNICATION");
  ASSERT_TRUE(comes_back(2s)) << flight.story().text();
  EXPECT_TRUE(flight.story().has("the change to mode operation stopped: plan default")) << flight.story().text();
  EXPECT_TRUE(flight.set_mode("operation").completed) << flight.story().text();
  EXPECT_EQ(flight.state("HELLO"), State::Operational);
}

}  // namespace
}  // namespace hirosco::testing
