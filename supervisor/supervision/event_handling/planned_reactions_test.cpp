// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/planned_reactions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;

struct PlannedReactionsTest : ::testing::Test {
  descriptor::Mission mission = testing::small_mission();
  void SetUp() override {
    descriptor::Event event;
    event.name = "HOT";
    event.severity = descriptor::Severity::Medium;
    mission.subsystems.front().subsystem.events = {event};
    event.name = "PROCESS_DIED";
    event.severity = descriptor::Severity::High;
    mission.supervisor.events = {event};
  }
  void plan(std::string name, std::string event, std::string mode, std::vector<descriptor::PlanStep> steps) {
    descriptor::Plan made;
    made.name = std::move(name);
    made.event = std::move(event);
    made.mode = std::move(mode);
    made.steps = std::move(steps);
    mission.plans.push_back(made);
  }
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> all;
    for (const PlannedReaction& each : planned_reactions(mission)) {
      std::string modes;
      for (const std::string& mode : each.modes) modes += mode + " ";
      all.push_back(each.subsystem + " " + each.event + " " + modes + each.plan + ": " + each.steps);
    }
    return all;
  }
};

TEST_F(PlannedReactionsTest, EveryEventHasItsReactionInEachMode) {
  plan("gently", "HOT", "narrow", {{"log"}});
  plan("died", "PROCESS_DIED", "", {{"restart", {3, 60, 100, 5}}, {"shut_down_network"}});
  EXPECT_THAT(lines(),
              ElementsAre("ARM PROCESS_DIED open narrow died: restart limit=3 within_s=60 pause_ms=100 to=commanded, "
                          "shut_down_network",
                          "ARM HOT open default: set_state state=SafeOperational", "ARM HOT narrow gently: log",
                          "HAND PROCESS_DIED open narrow died: restart limit=3 within_s=60 pause_ms=100 to=commanded, "
                          "shut_down_network",
                          "CAMERA PROCESS_DIED open narrow died: restart limit=3 within_s=60 pause_ms=100 "
                          "to=commanded, shut_down_network"));
}

TEST_F(PlannedReactionsTest, TheLossOfTheGroundIsToldOfTheGroundLinkAlone) {
  mission.ground.subsystem = "CAMERA";
  mission.supervisor.events.front().name = "GROUND_LINK_LOST";
  mission.supervisor.events.front().severity = descriptor::Severity::Medium;
  mission.modes.resize(1);
  plan("lost", "GROUND_LINK_LOST", "", {{"log"}});
  mission.plans.front().subsystem = mission.supervisor.name;
  EXPECT_THAT(lines(), ElementsAre("ARM HOT open default: set_state state=SafeOperational",
                                   "CAMERA GROUND_LINK_LOST open lost: log"));
  mission.subsystems.back().subsystem.events = mission.supervisor.events;
  EXPECT_THAT(lines(), ElementsAre("ARM HOT open default: set_state state=SafeOperational",
                                   "CAMERA GROUND_LINK_LOST open lost: log"))
      << "and once where it has the event itself";
}

TEST_F(PlannedReactionsTest, WhichPlanGivesWayToWhichIsSaidForEachSubsystem) {
  descriptor::Event event;
  event.severity = descriptor::Severity::Low;
  for (const char* name : {"FIRST", "SECOND", "THIRD", "FOURTH"}) {
    event.name = name;
    mission.subsystems.front().subsystem.events.push_back(event);
  }
  const descriptor::PlanStep safe{"set_state", {4}};
  plan("first", "FIRST", "", {safe});
  plan("second", "SECOND", "", {safe});
  plan("third", "THIRD", "", {{"shut_down_network"}});
  plan("fourth", "FOURTH", "", {{"set_state", {0}, "HAND"}});
  mission.plans[1].priority = 101;
  mission.plans[2].priority = 1;
  std::vector<std::string> ways;
  for (const PlannedPreemption& each : planned_preemptions(mission)) {
    std::string line = each.subsystem + ": " + each.plan + " <";
    for (const std::string& by : each.by) line += " " + by;
    ways.push_back(line);
  }
  EXPECT_THAT(ways,
              ElementsAre("ARM: default (medium) < default (high) second (low) third (low)",
                          "ARM: first (low) < default (high) default (medium) second (low) third (low)",
                          "ARM: second (low) < default (high) third (low)", "HAND: fourth (low) < default (high)"));
}

TEST_F(PlannedReactionsTest, PriorityAndWhomAStepMovesAreShown) {
  plan("other", "HOT", "", {{"set_state", {4}, "HAND"}});
  mission.plans[0].priority = 7;
  for (const PlannedReaction& each : planned_reactions(mission))
    if (each.event == "HOT") {
      EXPECT_EQ(each.priority, 7);
      EXPECT_EQ(each.steps, "set_state state=SafeOperational subsystem=HAND");
    }
}

TEST_F(PlannedReactionsTest, HowLongACommandMayTakeIsShown) {
  plan("out", "HOT", "", {{"command", {0, 1, 120}, {}, {"STOW", "0.5"}, {0.5}}});
  for (const PlannedReaction& each : planned_reactions(mission))
    if (each.event == "HOT") {
      EXPECT_EQ(each.steps, "command function=STOW arguments=0.5 done_within_s=120");
    }
}

}  // namespace
}  // namespace hirosco::supervisor
