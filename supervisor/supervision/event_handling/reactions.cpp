// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/reactions.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "supervisor/supervision/procedures/step_kinds.hpp"

namespace hirosco::supervisor {

using descriptor::Severity;

namespace {

/// What nothing overrides: whoever is gone must be stopped and taken down whatever else runs for it (hazard SF5).
[[nodiscard]] bool is_loss(std::string_view event) { return event == descriptor::event_of_death || event == "HANG"; }

}  // namespace

bool Reactions::take_event(std::uint16_t from, Octets message) {
  const auto event = pus::read_event_message(message);
  if (!event) return false;
  const descriptor::Subsystem& subsystem =
      from == supervisor_apid ? craft_.mission.supervisor : craft_.mission.find_subsystem(from)->subsystem;
  const auto declared = std::ranges::find(subsystem.events, event->id, &descriptor::Event::id);
  const std::string name = declared != subsystem.events.end() ? declared->name : std::to_string(event->id);
  // Damage makes nothing harmless that the descriptor calls severe.
  const Severity severity =
      declared != subsystem.events.end() ? std::max(event->severity, declared->severity) : event->severity;
  const std::string text = subsystem.name + " " + std::string{to_text(severity)} + " " +
                           describer_.describe_event(from, message.subspan(pus::event_message_id_at));
  // A report is in the log as the packet that it is.
  if (event->reported == pus::Reported::Yes) craft_.observer.told(craft_.platform.clock.onboard(), text);
  else craft_.tell(text, from);
  if (from == supervisor_apid) react_to_own(name, severity);
  else if (Member* origin = craft_.member(from); origin != nullptr && origin->alive()) react(*origin, name, severity);
  return true;
}

/// What we tell of a subsystem is answered where it is told: by the plan that names it or us, or the event, as severe as our
/// descriptor calls it.
Reactions::Answer Reactions::answer_to(const Member& origin, std::string_view event, Severity severity) const {
  const descriptor::Subsystem& supervisor = craft_.mission.supervisor;
  const bool ours = descriptor::is_about_subsystem(event) && origin.descriptor().find_event(event) == nullptr;
  const auto* declared = ours ? supervisor.find_event(event) : nullptr;
  if (declared != nullptr) severity = declared->severity;
  const Reaction reaction =
      choose_reaction(craft_.mission, {origin.descriptor().name, event, severity, craft_.mode->name,
                                       ours ? std::string_view{supervisor.name} : std::string_view{}});
  if (craft_.shutting_down) return {severity, {}};  // everything is on its way down already
  return {severity, steps_for(origin, reaction, event, {std::string{reaction.plan}, std::string{event}})};
}

void Reactions::act_first(const Member& origin, std::string_view event, Severity severity) const {
  for (const ProcedureStep& step : answer_to(origin, event, severity).steps)
    if (step.kind->act_first != nullptr) step.kind->act_first(step, means_);
}

void Reactions::react(Member& origin, std::string_view event, Severity told) {
  if (means_.losses.answers(origin.apid(), event)) return;
  const auto [severity, steps] = answer_to(origin, event, told);
  if (steps.empty()) return;
  // One plan at a time for a subsystem; only something worse overrides it.
  if (origin.recovery.outweighs(severity) && !is_loss(event)) return;
  begin(origin, severity, steps);
}

/// Of a plan, what there is to do for this subsystem about this event.
Stage Reactions::steps_for(const Member& subject, const Reaction& reaction, std::string_view event,
                           const Occasion& occasion) const {
  Stage steps;
  for (const descriptor::PlanStep& planned : reaction.steps) {
    const std::string_view only = descriptor::find_plan_step(planned.kind)->answers;
    const ProcedureStep step{find_step_kind(planned.kind), subject.apid(), planned.values, occasion};
    const bool does_something =
        step.kind->run != nullptr && (step.kind->answers == nullptr || step.kind->answers(step, craft_));
    if (does_something && (only.empty() || only == event)) steps.push_back(step);
  }
  return steps;
}

/// The steps of a plan, one after the other; while one that holds its subject runs, nothing lesser begins for that.
void Reactions::begin(Member& subject, Severity severity, const Stage& steps) {
  const bool holds = std::ranges::any_of(
      steps, [](const ProcedureStep& each) { return each.kind->holds == StepKind::Holds::Subject; });
  if (holds) subject.recovery.plan_begins(severity);
  Procedure procedure;
  for (const ProcedureStep& each : steps) procedure.stages.push_back({each});
  procedure.finished = [this, apid = subject.apid(), severity, holds](const ProcedureEnd& end) {
    Member& its = *craft_.member(apid);
    if (holds) its.recovery.plan_ended(severity);
    if (end.success || !its.alive()) return;
    // A plan that fails escalates once, to the whole network; shutting down has no further step.
    craft_.tell("plan failed (" + end.why + "): escalating", apid);
    react(its, "RECOVERY_FAILED", Severity::High);
  };
  ProcedureRunner{means_}.start(std::move(procedure));
}

/// The supervisor has no network and no actuators: what a plan asks for concerns all that have.
void Reactions::react_to_own(std::string_view event, Severity severity) {
  if (descriptor::is_about_subsystem(event) || event == descriptor::event_of_plans) return;
  const Reaction reaction = choose_reaction(
      craft_.mission,
      {craft_.mission.supervisor.name, event, severity, craft_.mode->name, {}, RaisedEvent::Origin::Supervisor});
  const auto acts = [](const descriptor::PlanStep& planned) { return find_step_kind(planned.kind)->run != nullptr; };
  if (craft_.shutting_down || std::ranges::none_of(reaction.steps, acts)) return;
  craft_.tell("plan " + std::string{reaction.plan} + ": all subsystems because of " + std::string{event},
              supervisor_apid);
  if (means_.under_way.cancel("plan " + std::string{reaction.plan})) craft_.fail();
  for (Member& subject : craft_.members) {
    if (!subject.alive() || craft_.is_ground_link(subject) || subject.recovery.running()) continue;
    const Stage steps = steps_for(subject, reaction, event, {std::string{reaction.plan}});
    if (!steps.empty()) begin(subject, severity, steps);
  }
}

/// Ground is told of each state that a plan commands, whatever becomes of it.
void Reactions::Desk::command(std::uint16_t apid, std::string_view function, std::optional<double> argument,
                              CommandDone done) {
  desk_.command(apid, function, argument, std::move(done));
  if (function == "SET_STATE" && argument) own_.announce("RECOVERY_STEP", {static_cast<double>(apid), *argument});
}

void Reactions::Desk::send(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data,
                           const MemoryHandle& memory, CommandDone done, Duration takes) {
  desk_.send(apid, service, subtype, data, memory, std::move(done), takes);
}

}  // namespace hirosco::supervisor
