// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/dry_run.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "hirosco/descriptor/model/supervisor_events.hpp"

namespace hirosco::supervisor {
namespace {

[[nodiscard]] std::string text_of(const descriptor::PlanStep& step) {
  using Kind = descriptor::StepAttribute::Kind;
  std::string text = step.kind;
  const auto attributes = descriptor::find_plan_step(step.kind)->attributes;
  for (std::size_t i = 0; i < attributes.size() && i < step.values.size(); ++i) {
    const auto& attribute = attributes[i];
    const std::int64_t value = step.values[i];
    std::string said = std::to_string(value);
    if (attribute.kind == Kind::SteadyState) said = to_text(static_cast<descriptor::State>(value));
    if (attribute.kind == Kind::Word)
      said = std::ranges::find(attribute.words, value, &descriptor::StepAttribute::Word::value)->text;
    text += fmt::format(" {}={}", attribute.name, said);
  }
  return text;
}

[[nodiscard]] std::string text_of(const Reaction& reaction) {
  std::vector<std::string> steps;
  for (const descriptor::PlanStep& step : reaction.steps) {
    const auto* word = descriptor::find_plan_step(step.kind);
    if (word != nullptr) steps.push_back(text_of(step));
  }
  return fmt::format("{}", fmt::join(steps, ", "));
}

void add(const descriptor::Mission& mission, RaisedEvent event, std::vector<PlannedReaction>& all) {
  const std::size_t first = all.size();
  for (const descriptor::Mode& mode : mission.modes) {
    event.mode = mode.name;
    const Reaction reaction = choose_reaction(mission, event);
    const auto same = std::find_if(all.begin() + static_cast<std::ptrdiff_t>(first), all.end(),
                                   [&](const PlannedReaction& each) { return each.plan == reaction.plan; });
    if (same != all.end()) same->modes.push_back(mode.name);
    else
      all.push_back({std::string{event.subsystem},
                     std::string{event.event},
                     event.severity,
                     {mode.name},
                     std::string{reaction.plan},
                     text_of(reaction)});
  }
}

}  // namespace

std::vector<PlannedReaction> planned_reactions(const descriptor::Mission& mission) {
  std::vector<PlannedReaction> all;
  for (const descriptor::Event& event : mission.supervisor.events)
    if (!descriptor::is_about_subsystem(event.name) && event.name != descriptor::event_of_plans)
      add(mission, {mission.supervisor.name, event.name, event.severity, {}, {}, RaisedEvent::Origin::Supervisor}, all);
  for (const descriptor::MissionSubsystem& member : mission.subsystems) {
    const descriptor::Subsystem& subsystem = member.subsystem;
    for (const descriptor::Event& event : mission.supervisor.events)
      if (descriptor::is_about_subsystem(event.name) && subsystem.find_event(event.name) == nullptr)
        add(mission, {subsystem.name, event.name, event.severity, {}, mission.supervisor.name}, all);
    for (const descriptor::Event& event : subsystem.events)
      add(mission, {subsystem.name, event.name, event.severity, {}}, all);
  }
  return all;
}

}  // namespace hirosco::supervisor
