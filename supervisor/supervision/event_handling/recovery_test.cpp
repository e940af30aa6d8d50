// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/recovery.hpp"

#include <gtest/gtest.h>

namespace hirosco::supervisor {
namespace {

using descriptor::Action;
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

TEST(Recovery, WithoutPlansThePapersDefaultsHold) {
  const descriptor::Mission mission;
  const auto action = [&](Severity severity) {
    return choose_reaction(mission, {.subsystem = "ARM", .event = "HOT", .severity = severity, .mode = "open"});
  };
  EXPECT_EQ(action(Severity::High).action, Action::ShutDownNetwork);
  EXPECT_EQ(action(Severity::Medium).action, Action::SetState);
  EXPECT_EQ(action(Severity::Medium).state, State::SafeOperational);
  EXPECT_EQ(action(Severity::Low).action, Action::Log);
  EXPECT_EQ(action(Severity::Info).action, Action::Log);
  EXPECT_EQ(action(Severity::High).plan, "default");
}

TEST(Recovery, APlanThatDoesNotMatchInOneCriterionIsNotTaken) {
  descriptor::Mission mission;
  mission.plans = {plan("other event", "COLD", "", "", {}), plan("other subsystem", "", "HAND", "", {}),
                   plan("other mode", "", "", "closed", {}), plan("other severity", "", "", "", {Severity::High}),
                   plan("nearly", "HOT", "ARM", "closed", {Severity::Medium})};
  EXPECT_EQ(choose_reaction(mission, raised).plan, "default");
}

TEST(Recovery, EventCountsMoreThanSubsystemThanModeThanSeverityThanNothing) {
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

TEST(Recovery, APlanForWhatTheSupervisorTellsOfASubsystemMayNameEither) {
  descriptor::Mission mission;
  mission.plans = {plan("of the other", "HANG", "HAND", "", {}), plan("of ours", "HANG", "SUPERVISOR", "", {})};
  RaisedEvent hang{.subsystem = "ARM", .event = "HANG", .severity = Severity::High, .mode = "open"};
  EXPECT_EQ(choose_reaction(mission, hang).plan, "default") << "an event of its own by that name";
  hang.teller = "SUPERVISOR";
  EXPECT_EQ(choose_reaction(mission, hang).plan, "of ours");
  mission.plans.insert(mission.plans.begin(), plan("of the arm", "HANG", "ARM", "", {}));
  EXPECT_EQ(choose_reaction(mission, hang).plan, "of the arm");
}

TEST(Recovery, OfEquallySpecificPlansTheFirstIsTaken) {
  descriptor::Mission mission;
  mission.plans = {plan("first", "HOT", "", "", {}), plan("second", "HOT", "", "", {})};
  EXPECT_EQ(choose_reaction(mission, raised).plan, "first");
}

TEST(Recovery, APlansActionAndStateAreHandedOn) {
  descriptor::Mission mission;
  mission.plans = {plan("stop", "HOT", "", "", {})};
  mission.plans[0].action = Action::SetState;
  mission.plans[0].state = State::ErrorOperational;
  const Reaction reaction = choose_reaction(mission, raised);
  EXPECT_EQ(reaction.action, Action::SetState);
  EXPECT_EQ(reaction.state, State::ErrorOperational);
}

}  // namespace
}  // namespace hirosco::supervisor
