// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/reactions.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "supervisor/supervision/procedures/steps/step_kinds.hpp"

namespace hirosco::supervisor {

using descriptor::Severity;

namespace {

/// What nothing overrides: whoever is gone must be stopped and taken down whatever else runs for it (hazard SF5).
[[nodiscard]] bool is_loss(std::string_view event) { return event == descriptor::event_of_death || event == "HANG"; }

}  // namespace

bool Reactions::take_event(std::uint16_t from, Octets message) {
  const auto event = pus::read_event_message(message);
  if (!event) return false;
  const descriptor::SubsystemDescriptor& subsystem = *craft_.mission.find_member(from);
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
Reaction Reactions::reaction_to(const Member& origin, std::string_view event, Severity& severity) const {
  const RaisedEvent raised = raised_of(craft_.mission, origin.descriptor(), event, severity, craft_.mode->name);
  severity = raised.severity;
  return choose_reaction(craft_.mission, raised);
}

std::vector<PlanStart> Reactions::answer_to(const Member& origin, std::string_view event, Severity severity) const {
  const Reaction reaction = reaction_to(origin, event, severity);
  std::vector<PlanStart> starts;
  if (craft_.shutting_down) return starts;  // everything is on its way down already
  const auto add = [&](const Member& subject) {
    if (PlanStart start = start_for(subject, &origin, reaction, severity, event); !start.steps.empty())
      starts.push_back(std::move(start));
  };
  add(origin);
  const auto names_somebody = [](const descriptor::PlanStep& planned) { return !planned.subsystem.empty(); };
  if (std::ranges::none_of(reaction.steps, names_somebody)) return starts;
  for (const Member& subject : craft_.members)
    if (&subject != &origin && subject.alive()) add(subject);
  return starts;
}

std::vector<std::uint16_t> Reactions::fenced_by(const Member& origin, std::string_view event, Severity severity) const {
  std::vector<std::uint16_t> fenced;
  for (const PlanStart& start : answer_to(origin, event, severity))
    for (const ProcedureStep& step : start.steps)
      if (step.kind->fences != nullptr)
        for (const std::uint16_t apid : step.kind->fences(step, means_)) fenced.push_back(apid);
  return fenced;
}

void Reactions::react(Member& origin, std::string_view event, Severity told) {
  if (means_.losses.answers(origin.apid(), event)) return;
  for (const PlanStart& start : answer_to(origin, event, told)) runs_.begin(start);
}

/// Of a plan, what there is to do for this subsystem about this event.
PlanStart Reactions::start_for(const Member& subject, const Member* whose, const Reaction& reaction, Severity severity,
                               std::string_view event) const {
  PlanStart start{.subject = subject.apid(),
                  .occasion = {std::string{reaction.plan}, std::string{event}},
                  .number = reaction.number,
                  .priority = reaction.priority,
                  .severity = severity,
                  .of_loss = &subject == whose && is_loss(event),
                  .origin = whose != nullptr ? whose->apid() : supervisor_apid};
  for (const descriptor::PlanStep& planned : reaction.steps) {
    const bool for_it = planned.subsystem.empty() ? whose == nullptr || whose == &subject
                                                  : planned.subsystem == subject.descriptor().name;
    const std::string_view only = descriptor::find_plan_step(planned.kind)->answers;
    const ProcedureStep step{find_step_kind(planned.kind),
                             subject.apid(),
                             planned.values,
                             {start.occasion.plan, whose != nullptr ? start.occasion.event : std::string{}},
                             planned.words,
                             planned.arguments};
    // What is about the craft is done once where a plan is for all.
    const bool elsewhere = whose == nullptr && step.kind->of_craft && &subject != first_of_all();
    if (!for_it || step.kind->run == nullptr || elsewhere || !(only.empty() || only == event)) continue;
    start.planned.push_back(step);
    if (does_something(step, craft_)) start.steps.push_back(step);
  }
  return start;
}

/// A plan that fails escalates once, to the plan for that; where that fails too, the whole network goes down, which has no
/// further step.
void Reactions::escalate(const PlanStart& plan, const ProcedureEnd& end) {
  Member& subject = *craft_.member(plan.subject);
  craft_.tell("plan failed (" + end.why + "): escalating", plan.subject);
  if (plan.occasion.event != event_of_failure) return react(subject, event_of_failure, Severity::High);
  take_down_network_of(subject);
}

void Reactions::take_down_network_of(const Member& subject) {
  const Reaction last{"default", {{"shut_down_network"}}};
  if (!craft_.shutting_down) runs_.begin(start_for(subject, &subject, last, Severity::High, event_of_failure));
}

const Member* Reactions::first_of_all() const {
  const auto first = std::ranges::find_if(craft_.members, [this](const Member& each) { return is_of_all(each); });
  return first != craft_.members.end() ? &*first : nullptr;
}

/// The supervisor has no network and no actuators: what a plan asks for concerns all that have.
std::vector<PlanStart> Reactions::answer_to_own(const Reaction& reaction, std::string_view event,
                                                Severity severity) const {
  std::vector<PlanStart> starts;
  for (const Member& subject : craft_.members)
    if (is_of_all(subject))
      if (PlanStart start = start_for(subject, nullptr, reaction, severity, event); !start.steps.empty())
        starts.push_back(std::move(start));
  return starts;
}

Reaction Reactions::reaction_to_own(std::string_view event, Severity severity) const {
  return choose_reaction(
      craft_.mission,
      {craft_.mission.supervisor.name, event, severity, craft_.mode->name, {}, RaisedEvent::Origin::Supervisor});
}

void Reactions::react_to_own(std::string_view event, Severity severity) {
  if (descriptor::is_about_subsystem(event) || descriptor::is_unplanned(event)) return;
  const Reaction reaction = reaction_to_own(event, severity);
  const auto acts = [](const descriptor::PlanStep& planned) { return find_step_kind(planned.kind)->run != nullptr; };
  if (craft_.shutting_down || std::ranges::none_of(reaction.steps, acts)) return;
  craft_.tell("plan " + std::string{reaction.plan} + ": all subsystems because of " + std::string{event},
              supervisor_apid);
  if (means_.under_way.cancel("plan " + std::string{reaction.plan} + " because of " + std::string{event}) ==
      Cancelled::ForGood)
    craft_.fail();
  for (const PlanStart& start : answer_to_own(reaction, event, severity)) runs_.begin(start);
}

// --- under another supervisor --------------------------------------------------------------------------------------------

PlanStart Reactions::answer_again(const Member& subject, const PlanUnderWay& before) const {
  const Member* origin = std::as_const(craft_).member(before.origin);
  if (origin == nullptr && before.origin != supervisor_apid) return {};
  Severity severity = before.severity;
  const Reaction reaction =
      origin != nullptr ? reaction_to(*origin, before.event, severity) : reaction_to_own(before.event, severity);
  return start_for(subject, origin, reaction, severity, before.event);
}

bool Reactions::begin_anew(Member& subject) {
  return plans_before_.begin_anew(subject, [&](const PlanUnderWay& before) { return answer_again(subject, before); });
}

void Reactions::fail_plan_of(Member& subject) {
  if (is_spent(subject.apid())) return take_down_network_of(subject);
  plans_before_.counts_as_failed(subject.apid());
  react(subject, event_of_failure, Severity::High);
}

/// What would be done now, by the code that does it, up to where it would begin.
void Reactions::preview(const pus::Request& asked, Octets data) {
  pus::Verification& verification = own_.verification();
  verification.accepted(asked);
  OctetReader reader{data};
  const auto apid = reader.get<std::uint16_t>();
  const auto id = reader.get<std::uint16_t>();
  const Member* origin = std::as_const(craft_).member(apid);
  const descriptor::Event* event = reader.exhausted() ? find_event(apid, id) : nullptr;
  if (event == nullptr)
    return verification.start_failed(asked, pus::FailureNotice{pus::FailureCode::UnknownIdentifier});
  verification.started(asked);
  pus::st129::PlanPreview preview;
  preview.subsystem = apid;
  preview.event = id;
  preview.severity = static_cast<std::uint8_t>(event->severity);
  if (craft_.shutting_down) preview.against.emplace_back("the craft shuts down");
  if (const std::uint8_t link = origin != nullptr ? means_.losses.answered_link(apid, event->name) : std::uint8_t{0}) {
    preview.plan = PlanRuns::loss_of_a_link;
    preview.name = "loss of link " + std::to_string(link);
    preview.steps.push_back({1, apid, std::string{to_text(craft_.mission.find_link(link)->on_loss)}});
  } else {
    Severity severity = event->severity;
    const Reaction reaction =
        origin != nullptr ? reaction_to(*origin, event->name, severity) : reaction_to_own(event->name, event->severity);
    preview.plan = reaction.number;
    preview.name = reaction.plan;
    look_ahead(origin != nullptr ? answer_to(*origin, event->name, event->severity)
                                 : answer_to_own(reaction, event->name, event->severity),
               preview);
  }
  std::array<std::byte, pus::st129::max_preview_octets> buffer;
  own_.telemetry().report(pus::st129::service_type, pus::st129::plan_preview, asked.source,
                          pus::st129::write_plan_preview(buffer, preview));
  verification.completed(asked);
}

/// What the supervisor tells of a subsystem is asked about under that one's id, what it tells of itself under its own.
const descriptor::Event* Reactions::find_event(std::uint16_t apid, std::uint16_t id) const {
  const auto find_in = [&](const descriptor::SubsystemDescriptor& subsystem) {
    const auto found = std::ranges::find(subsystem.events, id, &descriptor::Event::id);
    return found != subsystem.events.end() ? &*found : nullptr;
  };
  const Member* origin = std::as_const(craft_).member(apid);
  if (origin != nullptr)
    if (const auto* own = find_in(origin->descriptor())) return own;
  const auto* ours = find_in(craft_.mission.supervisor);
  if (ours == nullptr || descriptor::is_unplanned(ours->name)) return nullptr;
  const bool fits = descriptor::is_about_subsystem(ours->name)
                        ? origin != nullptr && descriptor::may_be_told_of(ours->name, origin->descriptor().name,
                                                                          craft_.mission.ground.subsystem)
                        : apid == supervisor_apid;
  return fits ? ours : nullptr;
}

void Reactions::look_ahead(const std::vector<PlanStart>& starts, pus::st129::PlanPreview& preview) const {
  for (const PlanStart& start : starts) {
    const std::string name = craft_.name_of(start.subject);
    if (const std::string why = runs_.against(start); !why.empty()) preview.against.push_back(name + ": " + why);
    std::uint8_t stage = 0;
    for (const ProcedureStep& step : start.steps) {
      const std::string what = text_of(step, craft_.mission);
      preview.steps.push_back({++stage, start.subject, what});
      if (step.kind->against == nullptr) continue;
      if (const std::string why = step.kind->against(step, means_); !why.empty())
        preview.against.push_back(name + ", " + what + ": " + why);
    }
  }
}

/// Ground is told of each state that a plan commands, whatever becomes of it.
void Reactions::Desk::command(std::uint16_t apid, std::string_view function, std::optional<double> argument,
                              CommandDone done, std::optional<std::uint64_t> free_at) {
  desk_.command(apid, function, argument, std::move(done), free_at);
  if (function == "SET_STATE" && argument) own_.announce("RECOVERY_STEP", {static_cast<double>(apid), *argument});
}

void Reactions::Desk::send(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data,
                           const MemoryHandle& memory, CommandDone done, Duration takes) {
  desk_.send(apid, service, subtype, data, memory, std::move(done), takes);
}

}  // namespace hirosco::supervisor
