// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/planned_reactions.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "supervisor/supervision/event_handling/plan_rank.hpp"
#include "supervisor/supervision/procedures/steps/step_kinds.hpp"

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
    if (i < step.words.size() && !step.words[i].empty()) said = step.words[i];
    else if (attribute.otherwise && attribute.kind != Kind::Word && attribute.kind != Kind::Number) continue;
    if (attribute.kind == Kind::SeenState) said = to_text(static_cast<descriptor::State>(value));
    if (attribute.kind == Kind::Word)
      said = std::ranges::find(attribute.words, value, &descriptor::StepAttribute::Word::value)->text;
    text += fmt::format(" {}={}", attribute.name, said);
  }
  if (!step.subsystem.empty()) text += " subsystem=" + step.subsystem;
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
                     reaction.priority,
                     text_of(reaction)});
  }
}

/// Every event that there may be, as it is told.
template <class Visit>
void each_event(const descriptor::Mission& mission, Visit&& visit) {
  for (const descriptor::Event& event : mission.supervisor.events)
    if (!descriptor::is_about_subsystem(event.name) && !descriptor::is_unplanned(event.name))
      visit(RaisedEvent{mission.supervisor.name, event.name, event.severity, {}, {}, RaisedEvent::Origin::Supervisor});
  for (const descriptor::MissionSubsystem& member : mission.subsystems) {
    const descriptor::SubsystemDescriptor& subsystem = member.subsystem;
    for (const descriptor::Event& event : mission.supervisor.events)
      if (descriptor::may_be_told_of(event.name, subsystem.name, mission.ground.subsystem) &&
          subsystem.find_event(event.name) == nullptr)
        visit(raised_of(mission, subsystem, event.name, event.severity, {}));
    for (const descriptor::Event& event : subsystem.events)
      visit(raised_of(mission, subsystem, event.name, event.severity, {}));
  }
}

/// What a plan would be for one subsystem.
struct Part {
  std::string label;
  PlanRank rank{};
  bool takes_time{false};  ///< and holds it meanwhile
};

[[nodiscard]] Part part_for(const descriptor::Mission& mission, const std::string& subject, const RaisedEvent& event,
                            const Reaction& reaction) {
  const bool of_supervisor = event.origin == RaisedEvent::Origin::Supervisor;
  const bool for_all = of_supervisor && subject != mission.ground.subsystem;
  std::vector<ProcedureStep> steps;
  Part part{fmt::format("{} ({})", reaction.plan, to_text(event.severity))};
  for (const descriptor::PlanStep& planned : reaction.steps) {
    const bool is_whose = of_supervisor ? for_all : subject == event.subsystem;
    if (planned.subsystem.empty() ? !is_whose : planned.subsystem != subject) continue;
    const StepKind* kind = find_step_kind(planned.kind);
    const std::string_view only = descriptor::find_plan_step(planned.kind)->answers;
    if (kind->run == nullptr || (!only.empty() && only != event.event)) continue;
    steps.push_back({.kind = kind, .values = planned.values});
    part.takes_time = part.takes_time || kind->holds == StepKind::Holds::Subject;
  }
  if (steps.empty()) part.label.clear();
  part.rank = {safety_of(steps), reaction.priority, event.severity};
  return part;
}

/// All that may run for it, each once.
[[nodiscard]] std::vector<Part> parts_for(const descriptor::Mission& mission, const std::string& subject) {
  std::vector<Part> parts;
  each_event(mission, [&](RaisedEvent event) {
    for (const descriptor::Mode& mode : mission.modes) {
      event.mode = mode.name;
      Part part = part_for(mission, subject, event, choose_reaction(mission, event));
      const auto same = [&](const Part& each) { return each.label == part.label && each.rank == part.rank; };
      if (!part.label.empty() && std::ranges::none_of(parts, same)) parts.push_back(std::move(part));
    }
  });
  return parts;
}

}  // namespace

std::vector<PlannedPreemption> planned_preemptions(const descriptor::Mission& mission) {
  std::vector<PlannedPreemption> all;
  for (const descriptor::MissionSubsystem& member : mission.subsystems) {
    const std::vector<Part> parts = parts_for(mission, member.subsystem.name);
    for (const Part& runs : parts) {
      if (!runs.takes_time) continue;
      PlannedPreemption found{member.subsystem.name, runs.label, {}};
      for (const Part& begins : parts)
        if (pre_empts(begins.rank, runs.rank) && std::ranges::find(found.by, begins.label) == found.by.end())
          found.by.push_back(begins.label);
      if (!found.by.empty()) all.push_back(std::move(found));
    }
  }
  return all;
}

std::vector<PlannedReaction> planned_reactions(const descriptor::Mission& mission) {
  std::vector<PlannedReaction> all;
  each_event(mission, [&](const RaisedEvent& event) { add(mission, event, all); });
  return all;
}

}  // namespace hirosco::supervisor
