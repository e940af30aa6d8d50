// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/plan_choice.hpp"

#include <algorithm>
#include <optional>

#include "hirosco/descriptor/model/supervisor_events.hpp"

namespace hirosco::supervisor {
namespace {

/// How specific a matching plan is; empty when it does not match.
[[nodiscard]] std::optional<int> specificity(const descriptor::Plan& plan, const RaisedEvent& event) {
  if (!plan.event.empty() && plan.event != event.event) return std::nullopt;
  if (!plan.subsystem.empty() && plan.subsystem != event.subsystem && plan.subsystem != event.teller)
    return std::nullopt;
  if (!plan.mode.empty() && plan.mode != event.mode) return std::nullopt;
  if (!plan.severities.empty() && std::ranges::find(plan.severities, event.severity) == plan.severities.end())
    return std::nullopt;
  const bool names_it = !plan.event.empty() || !plan.subsystem.empty();
  if (event.origin == RaisedEvent::Origin::Supervisor && !names_it) return std::nullopt;
  return (plan.event.empty() ? 0 : 8) + (plan.subsystem.empty() ? 0 : 4) + (plan.mode.empty() ? 0 : 2) +
         (plan.severities.empty() ? 0 : 1);
}

}  // namespace

RaisedEvent raised_of(const descriptor::Mission& mission, const descriptor::SubsystemDescriptor& subsystem,
                      std::string_view event, descriptor::Severity severity, std::string_view mode) {
  RaisedEvent raised{subsystem.name, event, severity, mode};
  const bool has_it_itself = subsystem.find_event(event) != nullptr;
  if (!descriptor::may_be_told_of(event, subsystem.name, mission.ground.subsystem) ||
      (has_it_itself && event != descriptor::event_of_ground_lost))
    return raised;
  raised.teller = mission.supervisor.name;
  if (const auto* told = mission.supervisor.find_event(event); told != nullptr)
    raised.severity = has_it_itself ? std::max(severity, told->severity) : told->severity;
  return raised;
}

Reaction choose_reaction(const descriptor::Mission& mission, const RaisedEvent& event) {
  const descriptor::Plan* best = nullptr;
  int best_score = -1;
  for (const auto& plan : mission.plans) {
    const auto score = specificity(plan, event);
    if (!score || *score <= best_score) continue;
    best = &plan;
    best_score = *score;
  }
  if (best != nullptr)
    return {best->name, best->steps, static_cast<std::uint16_t>(best - mission.plans.data() + 1), best->priority};
  if (event.origin == RaisedEvent::Origin::Supervisor) return {"default", {{"log"}}};
  switch (event.severity) {
    case descriptor::Severity::High: return {"default", {{"shut_down_network"}}};
    case descriptor::Severity::Medium:
      return {"default", {{"set_state", {static_cast<std::int64_t>(descriptor::State::SafeOperational)}}}};
    default: return {"default", {{"log"}}};
  }
}

}  // namespace hirosco::supervisor
