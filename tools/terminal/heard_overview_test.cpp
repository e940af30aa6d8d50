// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/heard_overview.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/terminal/verdict.hpp"

namespace hirosco::terminal {
namespace {

struct HeardTest : ::testing::Test {
  HeardTest() {
    for (const auto& [name, id] : {std::pair{"ARM", 10}, std::pair{"HAND", 11}}) {
      auto& member = mission.subsystems.emplace_back();
      member.subsystem.name = name;
      member.subsystem.id = static_cast<std::uint16_t>(id);
      member.subsystem.configurations.emplace_back().id = 2;
      member.subsystem.configurations.back().sampling = 500us;
    }
    auto& link = mission.links.emplace_back();
    link.id = 1;
    link.from = "ARM";
    link.to = "HAND";
    auto& mode = mission.modes.emplace_back();
    mode.name = "coupled";
    mode.id = 3;
    mode.establish = {1};
    for (const char* name : {"ARM", "HAND"})
      mode.commission.push_back(
          {.subsystem = name, .configuration = {}, .state = descriptor::State::Operational, .at = {}});
    tell("MODE", {3});
    tell("SUBSYSTEMS.APID", {1, 10, 11, 0});
    tell("SUBSYSTEMS.STATE", {5, 5, 5, 0});
    tell("SUBSYSTEMS.CONFIGURATION", {1, 2, 2, 0});
    tell("SUBSYSTEMS.INHIBITED", {0, 0, 0, 0});
    tell("SUBSYSTEMS.CYCLES", {100, 2000, 2001, 0});
    tell("SUBSYSTEMS.MISSED", {0, 0, 4, 0});
    tell("LINK_STATUS.LINK", {1, 0});
    tell("LINK_STATUS.IS_UP", {1, 0});
  }
  void tell(const std::string& name, std::vector<double> numbers) {
    values[name] = {.name = name, .unit = "", .values = std::move(numbers)};
  }

  descriptor::Mission mission;
  HeardValues values;
};

TEST_F(HeardTest, IsTheCraftThatTheSupervisorTellsOf) {
  const auto craft = heard_overview(mission, values);
  ASSERT_TRUE(craft);
  EXPECT_EQ(craft->mode, "coupled");
  EXPECT_EQ(craft->members[0].state, "Operational");
  EXPECT_EQ(craft->members[0].period_ns, 500'000U);
  EXPECT_EQ(craft->members[1].cycles, 2001U);
  EXPECT_EQ(craft->members[1].missed, 4U);
  EXPECT_TRUE(craft->links[0].up);
  EXPECT_EQ(judge(*craft).verdict, Verdict::Well);
}

TEST_F(HeardTest, IsUnwellWhereSomebodyIsDownInhibitedOrUnlinked) {
  values["SUBSYSTEMS.STATE"].values[1] = 255;
  EXPECT_EQ(judge(*heard_overview(mission, values)).line, "NOT WELL: 1 of 2 subsystems not as mode coupled has it");
  values["SUBSYSTEMS.STATE"].values[1] = 5;
  values["SUBSYSTEMS.INHIBITED"].values[2] = 4;
  EXPECT_EQ(judge(*heard_overview(mission, values)).verdict, Verdict::NotWell);
  values["SUBSYSTEMS.INHIBITED"].values[2] = 0;
  values["LINK_STATUS.IS_UP"].values[0] = 0;
  EXPECT_EQ(judge(*heard_overview(mission, values)).line, "NOT WELL: 1 link down");
}

TEST_F(HeardTest, IsNothingBeforeAllOfItWasTold) {
  for (const char* name : {"MODE", "SUBSYSTEMS.APID", "LINK_STATUS.LINK"}) {
    HeardValues fewer = values;
    fewer.erase(name);
    EXPECT_FALSE(heard_overview(mission, fewer)) << name;
  }
  tell("MODE", {77});
  EXPECT_FALSE(heard_overview(mission, values)) << "a mode that the mission does not have";
}

TEST_F(HeardTest, ColumnsOfUnlikeLengthsAndNumbersThatAreNoneAreNoMoreThanUnknown) {
  tell("SUBSYSTEMS.STATE", {5});
  tell("SUBSYSTEMS.CYCLES", {std::nan(""), -1, 1e300});
  const auto craft = heard_overview(mission, values);
  ASSERT_TRUE(craft);
  EXPECT_EQ(craft->members[0].state, "not running");
}

}  // namespace
}  // namespace hirosco::terminal
