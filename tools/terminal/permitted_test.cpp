// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/permitted.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::terminal {
namespace {

struct PermittedTest : ::testing::Test {
  PermittedTest() {
    auto& member = mission.subsystems.emplace_back();
    member.subsystem.name = "ARM";
    member.subsystem.id = 10;
    descriptor::Function move;
    move.name = "MOVE";
    move.service = 8;
    move.subtype = 1;
    move.states = 1U << static_cast<unsigned>(descriptor::State::Operational);
    member.subsystem.functions.push_back(move);
    for (const auto& [name, may] :
         {std::pair{"by_hand", true}, std::pair{"coupled", false}, std::pair{"alone", true}}) {
      auto& mode = mission.modes.emplace_back();
      mode.name = name;
      mode.id = static_cast<std::uint8_t>(mission.modes.size());
      if (may)
        mode.permits.push_back({.subsystem = "ARM", .functions = {"MOVE"}, .services = {}, .parameters = {}, .at = {}});
    }
  }
  descriptor::Mission mission;
};

TEST_F(PermittedTest, SaysInWhichModesAndWhileInWhichStates) {
  EXPECT_EQ(permitted_where(mission, mission.subsystems[0].subsystem, "MOVE"),
            "modes by_hand, alone while it is Operational");
}

TEST_F(PermittedTest, SaysNothingWhereItIsPermittedNowhere) {
  mission.modes[0].permits.clear();
  mission.modes[2].permits.clear();
  EXPECT_EQ(permitted_where(mission, mission.subsystems[0].subsystem, "MOVE"), "");
  EXPECT_EQ(permitted_where(mission, mission.subsystems[0].subsystem, "FLY"), "");
}

TEST_F(PermittedTest, SaysWhomAModePermitsWhatTheGroundMayNowhereAsk) {
  auto& pilot = mission.subsystems.emplace_back();
  pilot.subsystem.name = "PILOT";
  pilot.subsystem.id = 11;
  pilot.subsystem.commands = {{.subsystem = "ARM", .functions = {"MOVE"}, .at = {}, .apid = 10}};
  const auto& arm = mission.subsystems[0].subsystem;
  for (auto& mode : mission.modes)
    for (auto& permit : mode.permits) permit.from = {"PILOT"};
  EXPECT_EQ(permitted_where(mission, arm, "MOVE"), "");
  EXPECT_EQ(permitted_to_others(mission, arm, "MOVE"), "PILOT");
  EXPECT_EQ(permitted_to_others(mission, arm, "FLY"), "");
}

TEST_F(PermittedTest, SaysOfWhatWasAbortedAloneWhoMayHaveEndedIt) {
  EXPECT_EQ(ended_by(0x0204), "ended by another request, a stop, a plan or the loss of a device: hirosco why");
  EXPECT_EQ(ended_by(0x0202), "");
}

}  // namespace
}  // namespace hirosco::terminal
