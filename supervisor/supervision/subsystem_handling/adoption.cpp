// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/adoption.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "supervisor/supervision/data_handling/own_telecommands.hpp"
#include "supervisor/supervision/event_handling/reactions.hpp"
#include "supervisor/supervision/event_handling/safe_all.hpp"
#include "supervisor/supervision/modes/commissioning.hpp"
#include "supervisor/supervision/modes/modes.hpp"
#include "supervisor/supervision/modes/shutdown.hpp"
#include "supervisor/supervision/realtime_links/link_commands.hpp"
#include "supervisor/supervision/subsystem_handling/link_losses.hpp"
#include "supervisor/supervision/subsystem_handling/processes.hpp"

namespace hirosco::supervisor {

void Adoption::note(OctetWriter& writer) const {
  writer.put(craft_.mode->id).put(craft_.mode_epoch);
  const auto flag = [&](bool set) { writer.put(static_cast<std::uint8_t>(set ? 1 : 0)); };
  // What the supervisor before had begun is still to be ended until this one can.
  flag(parts_.commissioning.running() || (owes_ && commissioning_));
  flag(parts_.commissioning.succeeded());
  flag(craft_.shutting_down || (owes_ && shutting_down_));
  flag(craft_.failed());
  flag(parts_.safe_all.under_way() || (owes_ && stop_asked_));
  writer.put(static_cast<std::uint16_t>(craft_.members.size()));
  for (const Member& member : craft_.members) {
    const Before owed = owes_ ? before(member) : Before{};
    writer.put(member.apid());
    flag(member.alive() || owed.alive);
    flag(member.recovery.running() || owed.recovering);
    flag(member.was_started);
    flag(craft_.guard.fences(member.apid()) != member.fences_when_free);
  }
}

void Adoption::recall(OctetReader& reader) {
  const auto id = reader.get<std::uint8_t>();
  const auto mode = std::ranges::find(craft_.mission.modes, id, &descriptor::Mode::id);
  if (mode != craft_.mission.modes.end()) craft_.mode = &*mode;
  craft_.mode_epoch = reader.get<std::uint32_t>();
  const auto flag = [&] { return reader.get<std::uint8_t>() != 0; };
  commissioning_ = flag();
  if (flag()) parts_.commissioning.succeeded_before();
  shutting_down_ = flag();
  if (flag()) craft_.fail();
  stop_asked_ = flag();
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    const auto apid = reader.get<std::uint16_t>();
    Before& before = before_[apid];
    before.alive = flag();
    before.recovering = flag();
    before.started = flag();
    before.stopped = flag();
  }
}

Adoption::Before Adoption::before(const Member& member) const {
  const auto found = before_.find(member.apid());
  return found != before_.end() ? found->second : Before{};
}

void Adoption::begin(bool stop_asked) {
  remembered_ = parts_.memory.recall();
  stop_asked_ = stop_asked_ || stop_asked;
  if (stop_asked) parts_.safe_all.asked_meanwhile();
  craft_.tell(
      remembered_
          ? "this supervisor goes on for one that died"
          : "this supervisor goes on for one that died, and nothing tells what that knew: what moves is stopped",
      supervisor_apid);
  for (const auto& [apid, before] : before_)
    // Whom its plan stops stands fenced by that already; nobody else of its network is to lose what the plan leaves, or gives, it.
    if (before.recovering && !(before.alive && parts_.reactions.begins_anew(apid)))
      for (const std::uint16_t each : parts_.links.graph().network_of(apid)) stopped_.insert(each);
  waits_ = owes_ = true;
  waits_until_ = craft_.now + longest_start;
  for (Member& member : craft_.members) take_over(member);
  // Where anybody was stopped, what is read from now on may have been said before that.
  const bool stopped =
      std::ranges::any_of(craft_.members, [](const Member& member) { return !member.fences_when_free; });
  if (stop_asked_ || stopped) craft_.guard.void_what_was_said();
  craft_.taking_over = true;
  parts_.commissioning.start_itself([this](bool) {
    craft_.taking_over = false;
    go_on();
  });
}

/// Once: this supervisor is Operational, or cannot be by now (its log stands still), which must not hold up what is to stop.
void Adoption::go_on() {
  if (!std::exchange(waits_, false)) return;
  finish_what_was_begun();
  owes_ = false;
}

std::string_view Adoption::against(const Member& member) const {
  if (craft_.is_ground_link(member)) return {};
  if (!remembered_) return "nothing tells what was under way";
  if (stop_asked_) return "a stop was under way";
  if (commissioning_) return "it was being commissioned";
  if (shutting_down_) return "the flight was being ended";
  if (stopped_.contains(member.apid())) return "its network was being recovered";
  if (parts_.modes.was_moving(member.apid())) return "the mode was being changed";
  return {};
}

void Adoption::take_over(Member& member) {
  const Before known = before(member);
  // Of whom nothing is known it is not known either that it was free.
  member.was_started = known.started || (!remembered_ && member.described().starts);
  if (known.stopped || !remembered_) member.fences_when_free.reset();
  const std::string_view why_not = against(member);
  const auto adopted = parts_.processes.adopt(member, why_not);
  if (!adopted) return;
  // Who was permitted and did not act yet is let go by another telecommand; nobody has stopped it for that.
  if (why_not.empty() && member.fences_when_free) member.fences_when_free = craft_.guard.fences(member.apid());
  asked_devices_at_ = craft_.now + devices_answer;
  Page& page = pages_[member.apid()];
  page = {*adopted, craft_.now, craft_.now, false};
  hand_over(member, page);
}

void Adoption::hand_over(Member& member, Page& page) {
  page.again = craft_.now + asked_again_after;
  static_cast<void>(member.channel()->send({.kind = MessageKind::PermitPage, .memory = page.memory}));
}

void Adoption::confirmed(std::uint16_t apid) {
  pages_.erase(apid);
  craft_.guard.looks_at_its_page(apid);
}

/// The states of those that were not let go on follow, and what had been begun ends.
void Adoption::finish_what_was_begun() {
  parts_.telecommands.end_what_was_begun();
  parts_.links.end_what_was_begun();
  parts_.safe_all.tell_again();
  if (shutting_down_) {
    parts_.reactions.forget_what_was_under_way();
    parts_.shutdown.request("the supervisor before this one");
    // Who asked for it hears how it ends; and nobody moves on the way down.
    if (stop_asked_) parts_.safe_all.again();
    return;
  }
  // Of whoever was dead already and is being recovered from that the plan begins anew: nobody else knows how far it was.
  // Whom a version that was on trial has been taken from meanwhile has been let go, and comes back by that.
  for (Member& member : craft_.members)
    if (const Before known = before(member); !member.alive() && !member.exchanged && (known.alive || known.recovering))
      parts_.processes.found_dead(member);
  if (commissioning_) {
    craft_.tell("commissioning stopped: the supervisor died", supervisor_apid);
    craft_.fail();
  }
  parts_.modes.end_change("the supervisor died");
  recover_the_living();
  parts_.losses.end_what_was_begun();
  if (stop_asked_) return parts_.safe_all.again();
  for (Member& member : craft_.members)
    if (member.alive() && !craft_.is_ground_link(member) && member.state() == State::Operational &&
        craft_.guard.fenced(member.apid()) && !member.recovery.running() && !parts_.losses.leads(member.apid()))
      parts_.desk.command(member.apid(), "SET_STATE", static_cast<double>(State::SafeOperational), nullptr);
}

/// The plan that was under way for each begins anew, or counts as one that failed. Behind a stop of everything nothing is begun.
void Adoption::recover_the_living() {
  std::vector<Member*> failed;
  for (Member& member : craft_.members)
    if (member.alive() && before(member).recovering && (stop_asked_ || !parts_.reactions.begin_anew(member)))
      failed.push_back(&member);
  // First: a failure of others of its network may ask of it again what two supervisors have died by.
  std::ranges::stable_partition(failed, [&](const Member* each) { return parts_.reactions.is_spent(each->apid()); });
  // After all that begin anew, which nobody takes down meanwhile; whom one of those takes down goes down already.
  for (Member* member : failed)
    if (!member->recovery.going_down()) fail_plan_of(*member);
  parts_.reactions.forget_what_was_under_way();
}

void Adoption::fail_plan_of(Member& member) {
  craft_.tell(member.descriptor().name + ": the supervisor died in the midst of a plan, which counts as failed",
              member.apid());
  // That it would begin anew is why they were let go on.
  if (!stopped_.contains(member.apid()))
    for (const std::uint16_t each : parts_.links.graph().network_of(member.apid()))
      if (const Member* other = craft_.member(each); other != nullptr && !craft_.is_ground_link(*other))
        craft_.guard.fence(each);
  parts_.reactions.fail_plan_of(member);
}

/// The enable of a device may have run out before anybody could go on telling it: it has stopped and stays so, and its subsystem
/// follows it.
void Adoption::ask_devices() {
  for (Member& member : craft_.members) {
    if (!member.alive() || !craft_.guard.has_stopped_by_itself(member.apid())) continue;
    craft_.tell("a device of " + member.descriptor().name + " has stopped while no supervisor was there",
                member.apid());
    craft_.guard.fence(member.apid());
    if (member.state() == State::Operational && !member.recovery.running())
      parts_.desk.command(member.apid(), "SET_STATE", static_cast<double>(State::SafeOperational), nullptr);
  }
}

void Adoption::watch(TimePoint now) {
  if (asked_devices_at_ && now >= *asked_devices_at_) {
    asked_devices_at_.reset();
    ask_devices();
  }
  if (now > waits_until_) go_on();
  for (auto& [apid, page] : pages_) {
    Member& member = *craft_.member(apid);
    if (!member.alive() || page.given_up) continue;
    if (waits_) page.since = now;  // nobody reads what it says
    if (now - page.since > longest_change) {
      // It obeys a page that nobody can write any more.
      craft_.tell(member.descriptor().name + " does not look at its new permit page: it is ended", apid);
      craft_.guard.fence(apid);
      craft_.launcher.kill(member.process());
      page.given_up = true;
    } else if (now >= page.again) {
      hand_over(member, page);
    }
  }
  std::erase_if(pages_, [&](const auto& entry) { return !craft_.member(entry.first)->alive(); });
}

}  // namespace hirosco::supervisor
