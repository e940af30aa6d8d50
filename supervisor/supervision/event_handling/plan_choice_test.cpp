// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/plan_choice.hpp"

#include <gtest/gtest.h>

namespace hirosco::supervisor {
namespace {

using descriptor::Severity;
using descriptor::State;

descriptor::Plan plan(std::string name, std::string event, std::string subsystem, std::string mode,
                      std::vector<Severity> severities) {
  descriptor::Plan made;
  made.name = std::move(name);
  made.event = std::move(event);
  made.subsystem = std::move(subsystem);
  made.mode = std::move(mode);
  made.severities = std::move(severities);
  return made;
}

constexpr RaisedEvent raised{.subsystem = "ARM", .event = "HOT", .severity = Severity::Medium, .mode = "open"};

TEST(PlanChoice, WithoutPlansThePapersDefaultsHold) {
  const descriptor::Mission mission;
  const auto action = [&](Severity severity) {
    return choose_reaction(mission, {.subsystem = "ARM", .event = "HOT", .severity = severity, .mode = "open"})
        .steps.at(0);
  };
  EXPECT_EQ(action(Severity::High).kind, "shut_down_network");
  EXPECT_EQ(action(Severity::Medium).kind, "set_state");
  EXPECT_EQ(action(Severity::Medium).values, std::vector{static_cast<std::int64_t>(State::SafeOperational)});
  EXPECT_EQ(action(Severity::Low).kind, "log");
  EXPECT_EQ(action(Severity::Info).kind, "log");
  EXPECT_EQ(choose_reaction(mission, raised).plan, "default");
}

TEST(PlanChoice, APlanThatDoesNotMatchInOneCriterionIsNotTaken) {
  descriptor::Mission mission;
  mission.plans = {plan("other event", "COLD", "", "", {}), plan("other subsystem", "", "HAND", "", {}),
                   plan("other mode", "", "", "closed", {}), plan("other severity", "", "", "", {Severity::High}),
                   plan("nearly", "HOT", "ARM", "closed", {Severity::Medium})};
  EXPECT_EQ(choose_reaction(mission, raised).plan, "default");
}

TEST(PlanChoice, EventCountsMoreThanSubsystemThanModeThanSeverityThanNothing) {
  descriptor::Mission mission;
  mission.plans = {
      plan("anything", "", "", "", {}),     plan("severity", "", "", "", {Severity::Low, Severity::Medium}),
      plan("mode", "", "", "open", {}),     plan("mode and severity", "", "", "open", {Severity::Medium}),
      plan("subsystem", "", "ARM", "", {}), plan("subsystem, mode, severity", "", "ARM", "open", {Severity::Medium}),
      plan("event", "HOT", "", "", {}),     plan("all", "HOT", "ARM", "open", {Severity::Medium})};
  while (mission.plans.size() > 1) {
    EXPECT_EQ(choose_reaction(mission, raised).plan, mission.plans.back().name);
    mission.plans.pop_back();
  }
  EXPECT_EQ(choose_reaction(mission, raised).plan, "anything");
}

TEST(PlanChoice, APlanForWhatTheSupervisorTellsOfASubsystemMayNameEither) {
  descriptor::Mission mission;
  mission.plans = {plan("of the other", "HANG", "HAND", "", {}), plan("of ours", "HANG", "SUPERVISOR", "", {})};
  RaisedEvent hang{.subsystem = "ARM", .event = "HANG", .severity = Severity::High, .mode = "open"};
  EXPECT_EQ(choose_reaction(mission, hang).plan, "default") << "an event of its own by that name";
  hang.teller = "SUPERVISOR";
  EXPECT_EQ(choose_reaction(mission, hang).plan, "of ours");
  mission.plans.insert(mission.plans.begin(), plan("of the arm", "HANG", "ARM", "", {}));
  EXPECT_EQ(choose_reaction(mission, hang).plan, "of the arm");
}

TEST(PlanChoice, OfEquallySpecificPlansTheFirstIsTaken) {
  descriptor::Mission mission;
  mission.plans = {plan("first", "HOT", "", "", {}), plan("second", "HOT", "", "", {})};
  EXPECT_EQ(choose_reaction(mission, raised).plan, "first");
}

TEST(PlanChoice, APlansStepsAreHandedOnInTheirOrder) {
  descriptor::Mission mission;
  mission.plans = {plan("stop", "HOT", "", "", {})};
  mission.plans[0].steps = {{"restart", {3, 60, 100, 0}}, {"set_state", {7}}};
  const Reaction reaction = choose_reaction(mission, raised);
  ASSERT_EQ(reaction.steps.size(), 2U);
  EXPECT_EQ(reaction.steps[0].kind, "restart");
  EXPECT_EQ(reaction.steps[1].values, std::vector<std::int64_t>{7});
}

}  // namespace
}  // namespace hirosco::supervisor
