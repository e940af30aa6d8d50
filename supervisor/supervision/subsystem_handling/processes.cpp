// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/processes.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "supervisor/supervision/data_handling/own_telecommands.hpp"
#include "supervisor/supervision/data_handling/persistent_values/stored_values.hpp"
#include "supervisor/supervision/data_handling/reception.hpp"
#include "supervisor/supervision/data_handling/telecommands.hpp"
#include "supervisor/supervision/event_handling/ground_loss.hpp"
#include "supervisor/supervision/event_handling/reactions.hpp"
#include "supervisor/supervision/event_handling/safe_all.hpp"
#include "supervisor/supervision/realtime_links/link_commands.hpp"
#include "supervisor/supervision/resource_management/resource_handling.hpp"
#include "supervisor/supervision/subsystem_handling/ground_link_care.hpp"
#include "supervisor/supervision/subsystem_handling/replacement.hpp"
#include "supervisor/supervision/subsystem_handling/restoration.hpp"

namespace hirosco::supervisor {

using descriptor::Severity;

namespace {
/// How long a process may live on with its channel closed; what it does then cannot be known.
constexpr Duration closed_channel_limit = 1s;
/// The signal that ends whoever is not gone on with.
constexpr int killed = 9;

/// What the guard found of a device, as it is told and planned for.
struct DeviceFinding {
  std::string words;  ///< behind the name of its subsystem
  std::string_view event;
  Severity severity{Severity::Medium};
};

[[nodiscard]] std::string_view device_of(const descriptor::SubsystemDescriptor& subsystem, std::uint16_t place) {
  return place < subsystem.devices.size() ? std::string_view{subsystem.devices[place].name} : "?";
}

/// Where it was looked for.
[[nodiscard]] std::string inhibit_address(const descriptor::SubsystemDescriptor& subsystem, std::uint16_t place) {
  if (place >= subsystem.devices.size() || !subsystem.devices[place].enable) return "?";
  const descriptor::Endnode& enable = *subsystem.devices[place].enable;
  const FlowMeans* means = find_flow_means(enable.transfer);
  const bool name = means != nullptr && means->form == AddressForm::Name;
  return fmt::format("{} {}{}", to_text(enable.transfer), enable.address,
                     name ? " (.NAME behind it where the flight has --instance NAME)" : "");
}

[[nodiscard]] std::string_view switched_by(const descriptor::SubsystemDescriptor& subsystem, std::uint16_t place) {
  const auto& switches = subsystem.power_switches;
  return place < switches.size() ? std::string_view{switches[place].device} : "?";
}

[[nodiscard]] std::optional<DeviceFinding> device_finding(const descriptor::SubsystemDescriptor& subsystem,
                                                          const GuardFinding& finding) {
  using enum GuardFinding::Kind;
  const std::string_view device = device_of(subsystem, finding.device);
  const std::string_view switched = switched_by(subsystem, finding.device);
  const auto silent = [&](const std::string& how, std::string_view todo) {
    return DeviceFinding{
        fmt::format(": the second inhibit of its device {} {}: that it has heard a stop would be known "
                    "of nobody{}",
                    device, how, todo),
        "INHIBIT_SILENT"};
  };
  switch (finding.kind) {
    case InhibitSilent:
      return silent("does not answer at " + inhibit_address(subsystem, finding.device),
                    ", and without it the device never moves; its driver has to listen there");
    case InhibitOfOtherVersion: return silent("is of another version, build both from one hirosco", "");
    case InhibitLost:
      return DeviceFinding{
          fmt::format(": the second inhibit of its device {} has not answered in time: it is stopped; look at "
                      "its line and at who answers there, then let it go again",
                      device),
          "INHIBIT_LOST"};
    case InhibitFellBack:
      return DeviceFinding{fmt::format(": the second inhibit of its device {} goes on by another way", device),
                           "INHIBIT_FALL_BACK", Severity::Low};
    case PowerSilent:
      return DeviceFinding{fmt::format(": the power switch of its device {} has not answered in time: whether that has "
                                       "power is not known; look at its lines",
                                       switched),
                           "POWER_SILENT"};
    case PowerFellBack:
      return DeviceFinding{fmt::format(": the power switch of its device {} answers by another way", switched),
                           "POWER_FALL_BACK", Severity::Low};
    default: return std::nullopt;
  }
}

}  // namespace

void Processes::start_all() {
  for (const std::string& open : craft_.launcher.isolation_lacks())
    craft_.tell("subsystems are not isolated as they should be: " + open, supervisor_apid);
  if (const std::string more = craft_.launcher.isolation_not_asked(); !more.empty()) craft_.tell(more, supervisor_apid);
  for (Member& member : craft_.members) {
    const std::string& name = member.descriptor().name;
    if (!member.described().starts) {
      craft_.tell(name + " is not started with the flight: SET_STATE Offline starts it", member.apid());
      continue;
    }
    if (!launch(member)) craft_.fail();
    if (const std::string open = craft_.launcher.left_open(member.described()); !open.empty())
      craft_.tell(name + " is isolated but for what its endnodes and links need: it reaches " + open, member.apid());
    for (const auto device : descriptor::actuators_without_enable(member.descriptor()))
      craft_.tell(name + "'s " + std::string{device} + " has no second inhibit: that it has stopped is known from " +
                      name + " only",
                  member.apid());
    for (const auto& changed : member.described().overrides)
      craft_.tell(name + " begins with " + to_string(changed), member.apid());
  }
}

Result<> Processes::launch(Member& member) {
  const std::string& name = member.descriptor().name;
  const auto cannot = [&](const std::string& words, const Error& why) {
    craft_.tell("cannot " + words, member.apid());
    return fail(why);
  };
  const auto cannot_start = [&](const std::string& words) {
    return cannot("start " + name + ": " + words, {ErrorCode::Unavailable, "its process could not be started"});
  };
  if (!craft_.guard.holds(member.apid())) {
    const auto held = craft_.guard.add(member.described(), craft_.is_ground_link(member));
    // Nobody would see that it hangs, or take the enable of those devices that can be reached: it does not fly.
    if (!held)
      return cannot("hold the second inhibit of " + name + "'s devices: " + held.error().text,
                    {ErrorCode::Unavailable, "the second inhibit of its devices cannot be held"});
  }
  if (craft_.mission.isolation_required)
    if (const auto open = craft_.launcher.isolation_lacks(); !open.empty())
      return cannot_start("the mission wants it isolated, and " + open.front());
  if (const auto refused = craft_.launcher.refuse(member.described())) {
    parts_.own.announce("PROGRAM_REFUSED", {static_cast<double>(member.apid())});
    return cannot("start " + name + ": " + refused->words, refused->why);
  }
  if (const auto short_of = parts_.resources.claim(member)) return cannot_start(*short_of);
  auto launched = craft_.launcher.launch(member.described());
  if (!launched) {
    parts_.resources.release(member.apid());
    return cannot_start(launched.error().text);
  }
  if (!launched->not_held.empty())
    craft_.tell("not all of " + name + " is in the manifest: " + std::string{launched->not_held}, member.apid());
  if (!launched->not_isolated.empty()) {
    craft_.tell(name + " is not isolated: " + std::string{launched->not_isolated}, member.apid());
    if (craft_.mission.isolation_required) {
      craft_.launcher.kill(launched->process);
      parts_.resources.release(member.apid());
      return cannot_start("the mission wants it isolated");
    }
  }
  craft_.guard.started(member.apid(), *launched);
  tell_not_kept(member, launched->not_kept);
  member.started(std::move(*launched));
  if (!std::exchange(member.was_started, true) && member.fences_when_free)
    member.fences_when_free = craft_.guard.fences(member.apid());
  member.enter_mode(craft_.mode_epoch);
  craft_.tell("started " + name, member.apid());
  return ok();
}

void Processes::tell_not_kept(const Member& member, std::string_view why) {
  if (!why.empty())
    craft_.tell(fmt::format("{} ends with this supervisor, should that die: {}", member.descriptor().name, why),
                member.apid());
}

std::optional<MemoryHandle> Processes::adopt(Member& member, std::string_view against) {
  const std::string& name = member.descriptor().name;
  auto adopted = craft_.launcher.adopt(member.described());
  if (!adopted && !adopted.error().why.empty()) {
    craft_.tell(fmt::format("cannot go on with {}: {}; it is ended{}", name, adopted.error().why,
                            adopted.error().process != 0 ? " and has not gone yet" : ""),
                member.apid());
    leaving_[member.apid()] = {.process = adopted.error().process};
    member.was_started = true;
  }
  if (!adopted && !member.was_started) return std::nullopt;
  if (!craft_.guard.holds(member.apid()))
    if (const auto held = craft_.guard.add(member.described(), craft_.is_ground_link(member)); !held) {
      craft_.tell("cannot hold the second inhibit of " + name + "'s devices: " + held.error().text +
                      (adopted ? "; it is ended" : ""),
                  member.apid());
      if (adopted) {
        craft_.launcher.kill(adopted->launched.process);
        leaving_[member.apid()] = {.process = adopted->launched.process};
      }
      return std::nullopt;
    }
  if (!adopted) {
    craft_.guard.ended_before(member.apid());
    return std::nullopt;
  }
  member.was_started = true;
  // By its page as well as by what was noted: the guard may have stopped it after that.
  if (adopted->stopped) member.fences_when_free.reset();
  static_cast<void>(parts_.resources.claim(member));  // it has it already
  const std::string_view why = craft_.guard.adopt(member.apid(), *adopted, against);
  tell_not_kept(member, adopted->launched.not_kept);
  member.started(std::move(adopted->launched));
  member.enter_mode(craft_.mode_epoch);
  const bool operational = member.state() == State::Operational;
  craft_.tell(fmt::format("goes on with {}{}{}", name,
                          why.empty() || !operational ? "" : ", stopped: ", operational ? why : std::string_view{}),
              member.apid());
  return std::move(adopted->permit);
}

void Processes::found_dead(Member& member) {
  const std::uint16_t apid = member.apid();
  const auto leaving = leaving_.find(apid);
  if (leaving == leaving_.end()) return died(member, {});
  if (leaving->second.process == 0) {
    leaving_.erase(leaving);
    return died(member, {.by_signal = true, .value = killed});
  }
  leaving->second.missed = true;
  craft_.tell(member.descriptor().name + " hangs: it was ended and has not gone", apid);
  parts_.own.announce("HANG", {static_cast<double>(apid)});
  parts_.restoration.lost(apid);
  parts_.reactions.react(member, "HANG", Severity::High);
}

void Processes::watch_leaving() {
  for (Member& member : craft_.members) {
    const auto leaving = leaving_.find(member.apid());
    if (leaving == leaving_.end() || leaving->second.process == 0 || !craft_.launcher.ended(leaving->second.process))
      continue;
    leaving->second.process = 0;
    if (leaving->second.missed) found_dead(member);
  }
}

Result<> Processes::start(std::uint16_t apid) {
  Member* subject = craft_.member(apid);
  if (subject == nullptr) return fail(ErrorCode::NotFound, "no such subsystem", apid);
  if (subject->alive()) return ok();
  if (const auto leaving = leaving_.find(apid); leaving != leaving_.end() && leaving->second.process != 0)
    return fail(ErrorCode::Unavailable, "its process before has not gone yet", apid);
  if (subject->exchanged) return fail(ErrorCode::Unavailable, "another version of it is about to be started");
  HIROSCO_TRY(launch(*subject));
  if (craft_.is_ground_link(*subject)) parts_.ground_link.restore(*subject);
  return ok();
}

void Processes::let_go(Member& subject) {
  const std::uint16_t apid = subject.apid();
  parts_.reception.read(subject);  // its last words
  if (!subject.alive()) return;
  parts_.resources.release(apid);
  craft_.guard.forget(apid);
  subject.died();
  parts_.telecommands.outcome_unknown(apid);
  parts_.restoration.exchanged(apid);
  parts_.links.forget(apid);
  parts_.desk.fail_all_to(apid, "process ended");
}

void Processes::watch(TimePoint now) {
  watch_ends(Whom::All);
  watch_leaving();
  for (const Member& member : craft_.members) {
    if (!member.alive()) continue;
    craft_.guard.falls_with(member.apid(),
                            parts_.reactions.fenced_by(member, descriptor::event_of_death, Severity::High));
    tell_not_kept(member, craft_.launcher.take_not_kept(member.process()));
  }
  while (const auto apid = parts_.restarts.take_due(now))
    if (!craft_.shutting_down && !start(*apid)) parts_.restarts.again(*apid, now);
}

void Processes::watch_ends(Whom whom) {
  for (Member& subject : craft_.members) {
    if (!subject.alive() || (whom == Whom::Closed && !subject.closed_at)) continue;
    if (const auto end = craft_.launcher.ended(subject.process())) {
      parts_.reception.read(subject);  // its last words
      parts_.reception.tell_last_unreadable(subject);
      if (subject.alive()) died(subject, *end);
      continue;
    }
    parts_.reception.tell_unreadable(subject);
    if (subject.closed_at && craft_.now > *subject.closed_at + closed_channel_limit)
      craft_.launcher.kill(subject.process());
  }
}

void Processes::died(Member& subject, const ProcessEnd& end) {
  const std::uint16_t apid = subject.apid();
  parts_.resources.release(apid);
  if (craft_.shutting_down) {
    subject.died();
    parts_.stored.ended(apid);
    parts_.telecommands.outcome_unknown(apid);
    return parts_.desk.fail_all_to(apid, "process ended");
  }
  craft_.guard.forget(apid);
  const std::string how = (end.by_signal ? "signal " : "exit code ") + std::to_string(end.value);
  craft_.tell(subject.descriptor().name + " died: " + how, apid);
  parts_.own.announce("PROCESS_DIED", {static_cast<double>(apid)});
  // The network is what it was before the death: the others are told while the graph still has the links.
  // Nothing is sent to the dead one any more; telecommands that wait for it are refused when their turn comes.
  subject.died();
  parts_.replacement.died(apid);
  parts_.stored.ended(apid);
  parts_.telecommands.outcome_unknown(apid);
  parts_.restoration.lost(apid);
  parts_.reactions.react(subject, "PROCESS_DIED", Severity::High);
  parts_.restoration.answered(apid);
  parts_.links.forget(apid);
  parts_.desk.fail_all_to(apid, "process died");
}

void Processes::take_guard_findings() {
  using enum GuardFinding::Kind;
  for (const GuardFinding& finding : craft_.guard.take_findings()) {
    if (Member* subject = craft_.member(finding.apid); subject != nullptr) {
      hear_of(*subject, finding);
    } else if (finding.kind == StopAsked) {
      parts_.safe_all.asked();
    } else if (finding.kind == SupervisorStill) {
      parts_.own.announce("SUPERVISOR_STILL");
      parts_.safe_all.stood_still();
    }
  }
}

void Processes::hear_of(Member& subject, const GuardFinding& finding) {
  using enum GuardFinding::Kind;
  if (!subject.alive()) return;
  const auto tell = [&](std::string_view line) {
    craft_.tell(subject.descriptor().name + std::string{line}, subject.apid());
  };
  if (const auto found = device_finding(subject.descriptor(), finding)) {
    tell(found->words);
    parts_.own.announce(found->event, {static_cast<double>(subject.apid()), static_cast<double>(finding.device + 1)});
    return parts_.reactions.react(subject, found->event, found->severity);
  }
  switch (finding.kind) {
    case CycleHangs: tell(" hangs: its cycle stands still"); break;
    case ServiceHangs: tell(" hangs: its service loop stands still"); break;
    case PageDamaged: tell(" hangs: its vital or permit page is damaged"); break;
    case Starves: return tell("'s loops kept the processor from others: they have lost their real-time priority");
    case Back:
      parts_.restoration.recovered(subject.apid());
      parts_.ground_loss.moves_again(subject);
      return tell(" moves again");
    case Killed: return tell(" was ended: it did not come back or had not stopped in time");
    case Ended: return parts_.reception.give_up(subject);  // what it left unsaid is read when its process has gone
    default: return;
  }
  parts_.own.announce("HANG", {static_cast<double>(subject.apid())});
  parts_.restoration.lost(subject.apid());
  parts_.ground_loss.stands_still(subject, finding.kind == ServiceHangs ? Guard::service_limit : Duration{});
  parts_.reactions.react(subject, "HANG", Severity::High);
}

}  // namespace hirosco::supervisor
