// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/reactions.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/supervisor_events.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "supervisor/supervision/event_handling/recovery.hpp"
#include "supervisor/supervision/modes/commissioning.hpp"

namespace hirosco::supervisor {

using descriptor::Severity;

namespace {

/// What nothing overrides: whoever is gone must be stopped and taken down whatever else runs for it (findings SF5).
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
  if (event->reported == pus::Reported::Yes) craft_.observer.told(craft_.world.clock.onboard(), text);
  else craft_.tell(text, from);
  if (from == supervisor_apid) react_to_own(name, severity);
  else if (Member* origin = craft_.member(from); origin != nullptr && origin->alive()) react(*origin, name, severity);
  return true;
}

/// What we tell of a subsystem is answered where it is told: by the plan that names it or us, or the event, as severe as our
/// descriptor calls it (findings LW3).
void Reactions::react(Member& origin, std::string_view event, Severity severity) {
  const descriptor::Subsystem& supervisor = craft_.mission.supervisor;
  const bool ours = descriptor::is_about_subsystem(event) && origin.descriptor().find_event(event) == nullptr;
  const auto* declared = ours ? supervisor.find_event(event) : nullptr;
  if (declared != nullptr) severity = declared->severity;
  const Reaction reaction =
      choose_reaction(craft_.mission, {origin.descriptor().name, event, severity, craft_.mode->name,
                                       ours ? std::string_view{supervisor.name} : std::string_view{}});
  if (craft_.shutting_down) return;  // everything is on its way down already
  using enum Restarts::AtLimit;
  if (reaction.restart && event == descriptor::event_of_death &&
      !parts_.restarts.plan(origin.apid(), *reaction.restart, craft_.now,
                            craft_.is_ground_link(origin) ? GoesOn : StaysDown))
    craft_.tell(origin.descriptor().name + " stays down: it died too often", origin.apid());
  if (reaction.action == descriptor::Action::Log) return;
  // One plan at a time for a subsystem; only something worse overrides it.
  if (origin.recovering && *origin.recovering >= severity && !is_loss(event)) return;
  if (reaction.action == descriptor::Action::ShutDownNetwork) {
    origin.recovering = severity;
    return shut_down_network(origin, reaction.plan);
  }
  const auto state = origin.state();
  const bool to_safe = reaction.state == State::SafeOperational;
  if (to_safe && state != State::Operational) return;  // decision 11: elsewhere it is logged
  origin.recovering = severity;
  craft_.tell("plan " + std::string{reaction.plan} + ": " + origin.descriptor().name + " to " +
                  std::string{to_text(reaction.state)} + " because of " + std::string{event},
              origin.apid());
  const std::uint16_t apid = origin.apid();
  const auto done = [this, apid, severity](bool success, const std::string& why) {
    recovered(apid, severity);
    Member* subject = craft_.member(apid);
    if (success || subject == nullptr || !subject->alive()) return;
    // A plan that fails escalates once, to the whole network; shutting down has no further step.
    craft_.tell("plan failed (" + why + "): escalating", apid);
    react(*subject, "RECOVERY_FAILED", Severity::High);
  };
  recover_to(apid, reaction.state, done);
}

/// The supervisor has no network and no actuators: what a plan asks for concerns all that have.
void Reactions::react_to_own(std::string_view event, Severity severity) {
  if (descriptor::is_about_subsystem(event) || event == descriptor::event_of_plans) return;
  const Reaction reaction = choose_reaction(
      craft_.mission,
      {craft_.mission.supervisor.name, event, severity, craft_.mode->name, {}, RaisedEvent::Origin::Supervisor});
  if (reaction.action == descriptor::Action::Log || craft_.shutting_down) return;
  craft_.tell("plan " + std::string{reaction.plan} + ": all subsystems because of " + std::string{event}, 1);
  if (parts_.commissioning.cancel("plan " + std::string{reaction.plan})) craft_.failed = true;
  for (Member& subject : craft_.members) {
    if (!subject.alive() || craft_.is_ground_link(subject) || subject.recovering) continue;
    if (reaction.action == descriptor::Action::ShutDownNetwork) {
      shut_down_network(subject, reaction.plan);
    } else if (reaction.state != State::SafeOperational || subject.state() == State::Operational) {
      subject.recovering = severity;
      recover_to(subject.apid(), reaction.state,
                 [this, apid = subject.apid(), severity](bool, const std::string&) { recovered(apid, severity); });
    }
  }
}

/// One step of a plan: ground is told of it, whatever becomes of it.
void Reactions::recover_to(std::uint16_t apid, State state, CommandDone done) {
  parts_.desk.command(apid, "SET_STATE", static_cast<double>(state), std::move(done));
  parts_.own.announce("RECOVERY_STEP", {static_cast<double>(apid), static_cast<double>(state)});
}

/// The end of a recovery. One of lower severity that something worse has overridden does not end that.
void Reactions::recovered(std::uint16_t apid, Severity severity) {
  Member* subject = craft_.member(apid);
  if (subject == nullptr || subject->recovering != severity) return;
  subject->recovering.reset();
  subject->going_down = false;
}

void Reactions::shut_down_network(Member& origin, std::string_view plan) {
  auto network = parts_.links.network_of(origin.apid());
  // The ground link may carry sets of the network; it has no actuators, and ground must hear what goes on.
  std::erase_if(network, [&](std::uint16_t apid) {
    const Member* subject = craft_.member(apid);
    return subject != nullptr && subject != &origin && craft_.is_ground_link(*subject);
  });
  std::string names;
  for (const std::uint16_t apid : network) names += (names.empty() ? "" : ", ") + craft_.name_of(apid);
  // The actuators first, by shared memory: no packet, no queue and no disk is in that way.
  for (const std::uint16_t apid : network) craft_.guard.fence(apid);
  craft_.tell("plan " + std::string{plan} + ": network {" + names + "} to ErrorOperational and down", origin.apid());
  if (parts_.commissioning.cancel("plan " + std::string{plan})) craft_.failed = true;
  for (const std::uint16_t apid : network) {
    Member* subject = craft_.member(apid);
    if (subject == nullptr || !subject->alive()) continue;
    subject->recovering = Severity::High;
    if (!std::exchange(subject->going_down, true)) bring_down(*subject);
  }
}

void Reactions::bring_down(Member& subject) {
  const std::uint16_t apid = subject.apid();
  const auto to_offline = [this, apid](bool, const std::string&) {
    Member* again = craft_.member(apid);
    if (again == nullptr || !again->alive() || again->state() == State::Offline) return recovered(apid, Severity::High);
    recover_to(apid, State::Offline, [this, apid](bool success, const std::string& why) {
      recovered(apid, Severity::High);
      craft_.tell(craft_.name_of(apid) + (success ? " is Offline" : " did not reach Offline: " + why), apid);
    });
  };
  const auto state = subject.state();
  const bool can_stop =
      state == State::PreOperational || state == State::SafeOperational || state == State::Operational;
  if (!can_stop) return to_offline(true, {});
  recover_to(apid, State::ErrorOperational, to_offline);
}

}  // namespace hirosco::supervisor
