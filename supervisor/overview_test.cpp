// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/overview.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::supervisor {
namespace {

TEST(OverviewTest, KnowsWhomTheModeWantsWhereBeforeAnybodyRuns) {
  descriptor::Mission mission;
  mission.name = "PAIR";
  mission.start_mode = "coupled";
  for (const char* name : {"ARM", "LAMP"}) mission.subsystems.emplace_back().subsystem.name = name;
  for (const int id : {1, 2}) {
    auto& link = mission.links.emplace_back();
    link.id = static_cast<std::uint8_t>(id);
    link.from = "ARM";
    link.to = "LAMP";
  }
  descriptor::Mode mode;
  mode.name = "coupled";
  mode.commission.push_back(
      {.subsystem = "ARM", .configuration = {}, .state = descriptor::State::SafeOperational, .at = {}});
  mode.establish = {2};
  const Overview overview = blank_overview(mission, mode);
  ASSERT_EQ(overview.members.size(), 2U);
  EXPECT_EQ(overview.members[0].wanted, "SafeOperational");
  EXPECT_EQ(overview.members[1].wanted, "");
  EXPECT_EQ(overview.members[0].state, "not running");
  EXPECT_FALSE(overview.links[0].wanted);
  EXPECT_TRUE(overview.links[1].wanted);
  EXPECT_EQ(overview.usual_mode, "coupled");
}

TEST(OverviewTest, HasNothingInItsJsonThatSteersATerminal) {
  Overview overview{.mission = "A\x1b[2J", .mode = "\"quoted\"", .members = {}, .links = {}};
  const std::string json = json_of(overview, 1.5, {{"\xc3\xa4", "\\"}});
  for (const char letter : json) EXPECT_TRUE(letter >= ' ' && letter < 127) << json;
  EXPECT_THAT(json, ::testing::HasSubstr(R"("mode":"\"quoted\"")"));
}

}  // namespace
}  // namespace hirosco::supervisor
