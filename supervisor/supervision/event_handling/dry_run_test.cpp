// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/dry_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;

struct DryRunTest : ::testing::Test {
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

TEST_F(DryRunTest, EveryEventHasItsReactionInEachMode) {
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

}  // namespace
}  // namespace hirosco::supervisor
