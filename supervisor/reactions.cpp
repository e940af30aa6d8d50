// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/pus/event_message.hpp"
#include "supervisor/supervision/event_handling/recovery.hpp"
#include "supervisor/supervisor.hpp"

/// Event handling, subsystem handling and real-time link handling of the supervisor (paper 4.3 and 5).
namespace hirosco::supervisor {

using descriptor::Severity;

namespace {

/// How long a process may live on with its channel closed; what it does then cannot be known.
constexpr Duration closed_channel_limit = std::chrono::seconds{1};
constexpr Duration unreadable_period = std::chrono::seconds{1};

/// Events of the supervisor that are about a subsystem: the reaction is that subsystem's, where they are raised.
constexpr std::array about_subsystems{"PROCESS_DIED", "HANG",      "POWER_REFUSED",
                                      "POWER_LOW",    "LOAD_SHED", "RECOVERY_STEP"};

/// What nothing overrides: whoever is gone must be stopped and taken down whatever else runs for it (findings SF5).
[[nodiscard]] bool is_loss(std::string_view event) { return event == "PROCESS_DIED" || event == "HANG"; }

}  // namespace

/// Events are heard here and nowhere else: whether ST[05] reports one to ground is no matter of recovery (adr 0020).
void Supervisor::handle_event(std::uint16_t from, Octets message) {
  const auto event = pus::read_event_message(message);
  if (!event) return count_unreadable(from);
  const descriptor::Subsystem& subsystem = from == 1 ? mission_.supervisor : mission_.find_subsystem(from)->subsystem;
  const auto declared = std::ranges::find(subsystem.events, event->id, &descriptor::Event::id);
  const std::string name = declared != subsystem.events.end() ? declared->name : std::to_string(event->id);
  // Damage makes nothing harmless that the descriptor calls severe.
  const Severity severity =
      declared != subsystem.events.end() ? std::max(event->severity, declared->severity) : event->severity;
  const std::string text = subsystem.name + " " + std::string{to_text(severity)} + " " +
                           describer_.describe_event(from, message.subspan(pus::event_message_id_at));
  // A report is in the log as the packet that it is.
  if (event->reported == pus::Reported::Yes) parts_.observer.told(parts_.world.clock.onboard(), text);
  else tell(text, from);
  if (from == 1) return react_to_own(name, severity);
  if (Member* origin = member(from); origin != nullptr && origin->alive()) react(*origin, name, severity);
}

/// What is damaged or claims another sender is no loss: it is counted and told, and what follows is read (findings SF9).
void Supervisor::count_unreadable(std::uint16_t from) {
  ++counts_.misdirected;
  if (Member* origin = member(from)) ++origin->unreadable;
}

/// The first at once, then once a second how many: who says nothing else fills neither log nor console.
void Supervisor::tell_unreadable(Member& subject) {
  if (subject.unreadable == subject.unreadable_told || now_ < subject.next_unreadable_told) return;
  subject.next_unreadable_told = now_ + unreadable_period;
  tell(fmt::format("{}: {} messages could not be read", subject.descriptor().name,
                   subject.unreadable - std::exchange(subject.unreadable_told, subject.unreadable)),
       subject.apid());
}

void Supervisor::react(Member& origin, std::string_view event, Severity severity) {
  const Reaction reaction = choose_reaction(mission_, {origin.descriptor().name, event, severity, mode_->name});
  if (shutting_down_) return;  // everything is on its way down already
  using enum Restarts::AtLimit;
  if (reaction.restart && event == "PROCESS_DIED" &&
      !restarts_.plan(origin.apid(), *reaction.restart, now_, is_ground_link(origin) ? GoesOn : StaysDown))
    tell(origin.descriptor().name + " stays down: it died too often", origin.apid());
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
  tell("plan " + std::string{reaction.plan} + ": " + origin.descriptor().name + " to " +
           std::string{to_text(reaction.state)} + " because of " + std::string{event},
       origin.apid());
  const std::uint16_t apid = origin.apid();
  const auto done = [this, apid, severity](bool success, const std::string& why) {
    recovered(apid, severity);
    Member* subject = member(apid);
    if (success || subject == nullptr || !subject->alive()) return;
    // A plan that fails escalates once, to the whole network; shutting down has no further step.
    tell("plan failed (" + why + "): escalating", apid);
    react(*subject, "RECOVERY_FAILED", Severity::High);
  };
  recover_to(apid, reaction.state, done);
}

/// The supervisor has no network and no actuators: what a plan asks for concerns all that have.
void Supervisor::react_to_own(std::string_view event, Severity severity) {
  if (std::ranges::find(about_subsystems, event) != about_subsystems.end()) return;
  const Reaction reaction = choose_reaction(
      mission_, {mission_.supervisor.name, event, severity, mode_->name, RaisedEvent::Origin::Supervisor});
  if (reaction.action == descriptor::Action::Log || shutting_down_) return;
  tell("plan " + std::string{reaction.plan} + ": all subsystems because of " + std::string{event}, 1);
  if (cancel_commissioning("plan " + std::string{reaction.plan})) failed_ = true;
  for (Member& subject : members_) {
    if (!subject.alive() || subject.descriptor().name == mission_.ground.subsystem || subject.recovering) continue;
    if (reaction.action == descriptor::Action::ShutDownNetwork) {
      shut_down_network(subject, reaction.plan);
    } else if (reaction.state != State::SafeOperational || subject.state() == State::Operational) {
      subject.recovering = severity;
      recover_to(subject.apid(), reaction.state,
                 [this, apid = subject.apid(), severity](bool, const std::string&) { recovered(apid, severity); });
    }
  }
}

/// Commissioning goes on with what a recovery takes down as if nothing had happened: it ends with it.
bool Supervisor::cancel_commissioning(std::string_view why) {
  if (shutting_down_ || !sequence_.running()) return false;
  sequence_.cancel();
  tell("commissioning stopped: " + std::string{why}, 1);
  return true;
}

/// One step of a plan: ground is told of it, whatever becomes of it.
void Supervisor::recover_to(std::uint16_t apid, State state, CommandDone done) {
  command(apid, "SET_STATE", static_cast<double>(state), std::move(done));
  engine_.announce("RECOVERY_STEP", {static_cast<double>(apid), static_cast<double>(state)});
}

/// The end of a recovery. One of lower severity that something worse has overridden does not end that.
void Supervisor::recovered(std::uint16_t apid, Severity severity) {
  Member* subject = member(apid);
  if (subject == nullptr || subject->recovering != severity) return;
  subject->recovering.reset();
  subject->going_down = false;
}

void Supervisor::shut_down_network(Member& origin, std::string_view plan) {
  auto network = links_.graph().network_of(origin.apid());
  // The ground link may carry sets of the network; it has no actuators, and ground must hear what goes on.
  std::erase_if(network, [&](std::uint16_t apid) {
    const Member* subject = member(apid);
    return subject != nullptr && subject != &origin && subject->descriptor().name == mission_.ground.subsystem;
  });
  std::string names;
  for (const std::uint16_t apid : network) names += (names.empty() ? "" : ", ") + name_of(apid);
  // The actuators first, by shared memory: no packet, no queue and no disk is in that way.
  for (const std::uint16_t apid : network) parts_.guard.fence(apid);
  tell("plan " + std::string{plan} + ": network {" + names + "} to ErrorOperational and down", origin.apid());
  if (cancel_commissioning("plan " + std::string{plan})) failed_ = true;
  for (const std::uint16_t apid : network) {
    Member* subject = member(apid);
    if (subject == nullptr || !subject->alive()) continue;
    subject->recovering = Severity::High;
    if (!std::exchange(subject->going_down, true)) bring_down(*subject);
  }
}

void Supervisor::bring_down(Member& subject) {
  const std::uint16_t apid = subject.apid();
  const auto to_offline = [this, apid](bool, const std::string&) {
    Member* again = member(apid);
    if (again == nullptr || !again->alive() || again->state() == State::Offline) return recovered(apid, Severity::High);
    recover_to(apid, State::Offline, [this, apid](bool success, const std::string& why) {
      recovered(apid, Severity::High);
      tell(name_of(apid) + (success ? " is Offline" : " did not reach Offline: " + why), apid);
    });
  };
  const auto state = subject.state();
  const bool can_stop =
      state == State::PreOperational || state == State::SafeOperational || state == State::Operational;
  if (!can_stop) return to_offline(true, {});
  recover_to(apid, State::ErrorOperational, to_offline);
}

void Supervisor::after_stop(std::string_view why) {
  tell(std::string{why} + ": every actuator inhibited", 1);
  // Commissioning would lift the fences again with its next step.
  cancel_commissioning(why);
  for (Member& subject : members_) {
    // The ground link has no actuators and is needed now more than ever.
    const bool spared = subject.descriptor().name == mission_.ground.subsystem;
    if (!subject.alive() || spared || subject.state() != State::Operational) continue;
    command(subject.apid(), "SET_STATE", static_cast<double>(State::SafeOperational), nullptr);
  }
}

/// What became of a stop is told by who was to stop: the devices where they can be asked.
void Supervisor::follow_stops() {
  for (auto pending = stops_.begin(); pending != stops_.end();) {
    const auto answers = parts_.guard.stop_outcome(pending->stop);
    if (!answers) return;
    pus::FailureNotice notice{pus::FailureCode::DeviceError};
    bool all = true;
    for (const StopAnswer& answer : *answers) {
      if (answer.killed)
        tell(name_of(answer.apid) + " was ended: " + answer.name + " had not stopped in time", answer.apid);
      if (answer.stopped) continue;
      all = false;
      tell(answer.name + " of " + name_of(answer.apid) + " did not confirm that it stopped", answer.apid);
      if (notice.data().size() + sizeof answer.apid <= pus::FailureNotice::max_data_octets) notice.with(answer.apid);
    }
    if (all) tell("everything has stopped", 1);
    if (pending->request && all) engine_.verification().completed(*pending->request);
    if (pending->request && !all) engine_.verification().completion_failed(*pending->request, notice);
    pending = stops_.erase(pending);
  }
}

// --- subsystem handling ------------------------------------------------------------------------------------------------

void Supervisor::watch_ends(bool all) {
  for (Member& subject : members_) {
    if (!subject.alive() || (!all && !subject.closed_at)) continue;
    if (const auto end = parts_.launcher.ended(subject.process())) {
      receive_from(subject);  // its last words
      subject.next_unreadable_told = now_;
      tell_unreadable(subject);
      if (subject.alive()) member_died(subject, *end);
      continue;
    }
    tell_unreadable(subject);
    if (subject.closed_at && now_ > *subject.closed_at + closed_channel_limit) parts_.launcher.kill(subject.process());
  }
}

void Supervisor::take_guard_findings() {
  for (const GuardFinding& finding : parts_.guard.take_findings()) {
    if (Member* subject = member(finding.apid); subject != nullptr) {
      hear_of(*subject, finding.kind);
      continue;
    }
    if (finding.kind == GuardFinding::Kind::StopAsked) {
      stops_.push_back({parts_.guard.stop_all(), std::nullopt});
      after_stop("stop by signal or local socket");
    } else if (finding.kind == GuardFinding::Kind::SupervisorStill) {
      engine_.announce("SUPERVISOR_STILL");
      after_stop("the supervisor itself stood still");
    }
  }
}

void Supervisor::hear_of(Member& subject, GuardFinding::Kind what) {
  using enum GuardFinding::Kind;
  if (!subject.alive()) return;
  const std::string& name = subject.descriptor().name;
  switch (what) {
    case CycleHangs: tell(name + " hangs: its cycle stands still", subject.apid()); break;
    case ServiceHangs: tell(name + " hangs: its service loop stands still", subject.apid()); break;
    case PageDamaged: tell(name + " hangs: its vital or permit page is damaged", subject.apid()); break;
    case Back: return tell(name + " moves again", subject.apid());
    case Killed: return tell(name + " was ended: it did not come back or had not stopped in time", subject.apid());
    default: return;
  }
  engine_.announce("HANG", {static_cast<double>(subject.apid())});
  react(subject, "HANG", Severity::High);
}

void Supervisor::restart_due(TimePoint now) {
  while (const auto apid = restarts_.take_due(now)) {
    Member* subject = member(*apid);
    if (subject == nullptr || subject->alive() || shutting_down_) continue;
    launch(*subject);
    if (subject->alive() && is_ground_link(*subject)) restore_ground_link(*subject);
  }
}

/// In Offline, and after that until a configuration is in force, the ground link hears nobody who could bring it up again,
/// whether a fault or a telecommand put it there.
void Supervisor::watch_ground_link(TimePoint now) {
  const auto link = std::ranges::find_if(members_, [&](const Member& subject) { return is_ground_link(subject); });
  if (link == members_.end()) return;
  const bool deaf = link->state() == State::Offline || link->configuration() == 0;
  const bool lost = link->alive() && deaf && !shutting_down_ && !sequence_.running() && !ground_link_.running();
  if (!lost) return ground_link_lost_at_.reset();
  if (!ground_link_lost_at_) ground_link_lost_at_ = now;
  if (now - *ground_link_lost_at_ < ground_link_patience_) return;
  ground_link_lost_at_.reset();
  restore_ground_link(*link);
}

/// Without the ground link nobody could command anything: it comes back to what its mode asks for by itself, or, while links
/// that this requires are down, to a configuration that requires none that is.
void Supervisor::restore_ground_link(Member& subject) {
  const descriptor::CommissionStep* wanted = nullptr;
  for (const descriptor::Mode* mode : {mode_, mission_.find_mode(mission_.start_mode)}) {
    if (mode == nullptr) continue;
    for (const auto& step : mode->commission)
      if (wanted == nullptr && step.subsystem == subject.descriptor().name) wanted = &step;
  }
  if (wanted == nullptr) return;
  const descriptor::Subsystem& subsystem = subject.descriptor();
  const auto* configuration = subsystem.find_configuration(wanted->configuration);
  const auto able = [&](const descriptor::Configuration& one) { return !links().absent_for(subsystem.id, one); };
  if (!able(*configuration)) {
    const auto other = std::ranges::find_if(subsystem.configurations, able);
    if (other != subsystem.configurations.end()) configuration = &*other;
  }
  std::vector<Sequence::Stage> stages;
  const auto add = [&](std::string_view function, double argument, std::string text) {
    stages.push_back({{subsystem.id, subsystem.name, std::string{function}, argument, std::move(text)}});
  };
  const auto take_to = [&](State state) { add("SET_STATE", static_cast<double>(state), std::string{to_text(state)}); };
  if (subject.state() == State::ErrorOperational) take_to(State::PostOperational);
  if (subject.state() != State::PreOperational) take_to(State::PreOperational);
  add("CONFIGURE", configuration->id, "configuration " + configuration->name);
  for (const State state : {State::SafeOperational, State::Operational})
    if (state <= wanted->state) take_to(state);
  ground_link_.start(std::move(stages), Sequence::OnFailure::Stop, [this](bool success, const std::string& why) {
    ground_link_patience_ = success ? ground_link_pause : std::min(2 * ground_link_patience_, Restarts::longest_pause);
    tell(success ? "the ground link is back" : "the ground link did not come back: " + why);
  });
}

// --- power -------------------------------------------------------------------------------------------------------------

void Supervisor::observe_power() {
  const auto demand_w = [](const descriptor::Subsystem& subject, std::uint8_t id) {
    const auto* configuration = subject.find_configuration(id);
    return configuration != nullptr ? configuration->power_w : 0;
  };
  const auto own = static_cast<std::uint8_t>(own_vital_->configuration.load(std::memory_order_relaxed));
  power_.observe(1, engine_.state(), demand_w(mission_.supervisor, own), now_);
  for (const Member& subject : members_)
    power_.observe(subject.apid(), subject.alive() ? subject.state() : std::nullopt,
                   demand_w(subject.descriptor(), subject.configuration()), now_);
}

void Supervisor::tell_shortage(std::uint16_t apid, const pus::FailureNotice& notice) {
  OctetReader reader{notice.data()};
  const auto watts = [&] { return reader.get<std::uint32_t>() * 1e-3; };
  const double budget_w = watts(), reserved_w = watts(), requested_w = watts();
  tell(fmt::format("power short: {} asks for {} W, {} W of {} W are reserved", name_of(apid), requested_w, reserved_w,
                   budget_w),
       apid);
  engine_.announce("POWER_REFUSED", {static_cast<double>(apid), budget_w, reserved_w, requested_w});
}

/// FC9 during use. Less than a tenth left: whoever draws stops acting. Less than is reserved: load is shed.
void Supervisor::set_power_budget(double budget_w) {
  constexpr double least_margin = 0.1;
  power_.set_budget(budget_w);
  observe_power();
  const double limit_w = power_.budget_mw() * 1e-3, reserved_w = power_.reserved_mw() * 1e-3;
  tell(fmt::format("power budget {} W, {} W are reserved", limit_w, reserved_w), 1);
  if (power_.overdrawn()) return shed_load();
  if (reserved_w <= (1 - least_margin) * limit_w) return;
  engine_.announce("POWER_LOW", {limit_w, reserved_w});
  for (Member& subject : members_)
    if (power_.held_mw(subject.apid()) != 0 && subject.descriptor().name != mission_.ground.subsystem)
      react(subject, "POWER_LOW", Severity::Medium);
}

/// The last of the mission first, each with its network, until the rest fits; the ground link never.
void Supervisor::shed_load() {
  // Told once: a mission may have a plan that does nothing about it.
  if (power_.newly_overdrawn()) engine_.announce("LOAD_SHED", {power_.budget_mw() * 1e-3, power_.reserved_mw() * 1e-3});
  if (!power_.overdrawn() || shutting_down_) return;
  const auto stays_mw = [&] {
    std::uint32_t sum_mw = power_.held_mw(1);
    for (const Member& subject : members_)
      if (!subject.going_down) sum_mw += power_.held_mw(subject.apid());
    return sum_mw;
  };
  for (auto subject = members_.rbegin(); subject != members_.rend() && stays_mw() > power_.budget_mw(); ++subject) {
    const bool spared = subject->descriptor().name == mission_.ground.subsystem;
    if (spared || subject->going_down || power_.held_mw(subject->apid()) == 0) continue;
    react(*subject, "LOAD_SHED", Severity::High);
  }
}

// --- the end of a process ----------------------------------------------------------------------------------------------

void Supervisor::member_died(Member& subject, const ProcessEnd& end) {
  const std::uint16_t apid = subject.apid();
  if (shutting_down_) {
    subject.died();
    return fail_requests_to(apid, "process ended");
  }
  parts_.guard.forget(apid);
  const std::string how = (end.by_signal ? "signal " : "exit code ") + std::to_string(end.value);
  tell(subject.descriptor().name + " died: " + how, apid);
  engine_.announce("PROCESS_DIED", {static_cast<double>(apid)});
  // The network is what it was before the death: the others are told while the graph still has the links.
  // Nothing is sent to the dead one any more; telecommands that wait for it are refused when their turn comes.
  subject.died();
  // Whatever it had begun will never be reported by itself (findings LW1).
  for (const pus::Request& request : outstanding_.take(apid))
    engine_.verification().completion_failed(request, pus::FailureNotice{pus::FailureCode::OutcomeUnknown});
  react(subject, "PROCESS_DIED", Severity::High);
  links_.forget(apid);
  fail_requests_to(apid, "process died");
}

void Supervisor::link_changed(const descriptor::MissionLink& link, bool up, const std::string& text) {
  watched_links_.erase(link.id);
  // Without a mapping the link is only not told about.
  if (auto mapping = up ? parts_.world.memory.map(links_.memory_of(link.id), Access::ReadOnly)
                        : Result<Mapping>{fail(ErrorCode::NotFound, "link is down")})
    watched_links_.emplace(link.id, std::move(*mapping));
  tell("link " + std::to_string(link.id) + " " + link.from + "." + link.provides + " -> " + link.to +
       (up ? " up: " : " down: ") + text);
}

}  // namespace hirosco::supervisor
