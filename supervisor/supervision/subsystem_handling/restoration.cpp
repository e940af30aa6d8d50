// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/restoration.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "supervisor/supervision/procedures/steps/way_there.hpp"

namespace hirosco::supervisor {

void Restoration::lost(std::uint16_t apid) {
  if (!means_.commanded.in_use() || craft_.shutting_down) return;
  // Whoever of them is on its way up again goes there from the beginning.
  if (means_.commanded.wanted(apid) != nullptr) runner_.cancel();
  // Neither the old mode nor the new one holds while it changes, and who is commissioned is brought up by nobody else.
  if (under_way_.running()) return;
  const auto earlier = losses_.find(apid);
  if (earlier != losses_.end() && craft_.now - earlier->second.at <= hang_before_death) return;
  losses_.insert_or_assign(apid, look(apid));
}

Restoration::Loss Restoration::look(std::uint16_t apid) const {
  Loss loss{.at = craft_.now, .members = {}, .links = {}};
  for (const std::uint16_t member : means_.links.taken_down_with(apid)) {
    for (const std::uint8_t link : means_.links.links_of(member)) loss.links.insert(link);
    const Member* one = craft_.member(member);
    if (one == nullptr || craft_.is_ground_link(*one)) continue;
    const CommandedState* pending = means_.commanded.wanted(member);
    CommandedState& before = loss.members[member];
    before = pending != nullptr ? *pending
             : member == apid   ? means_.commanded.of(member)
                                : means_.commanded.of_partner(member);
    before.may_have_set(means_.commanded.of(member));  // on its way back, perhaps
  }
  return loss;
}

void Restoration::answered(std::uint16_t apid) {
  const auto most = means_.restarts.take_most(apid);
  auto found = losses_.extract(apid);
  if (!found.empty())  // of one that hung it is the record of before
    for (auto& [member, commanded] : found.mapped().members) commanded.may_have_set(means_.commanded.of(member));
  means_.commanded.ended(apid);
  // The ground link comes back by itself in every mission (docs/adr/0043), and what hung on it waits for the ground.
  if (craft_.is_ground_link(*craft_.member(apid))) return;
  if (most.value_or(State::Offline) == State::Offline || found.empty()) {
    if (means_.commanded.wanted(apid) != nullptr)
      static_cast<void>(cancel(craft_.name_of(apid) + " does not come back"));
    return;
  }
  Loss& loss = found.mapped();
  for (auto& [member, commanded] : loss.members) {
    commanded.lower(*most);
    if (const auto names = commanded.unrepeated_names(craft_.member(member)->descriptor());
        !names.empty() && commanded.state() != State::Offline) {
      const bool moved = commanded.state() == State::Operational;
      commanded.lower(State::SafeOperational);
      craft_.tell(
          fmt::format("{} comes back {} functions had set: {}", craft_.name_of(member),
                      moved ? "to Safe-Operational only, without what" : "without what", fmt::join(names, ", ")),
          member);
    }
    for (const std::string& parameter : commanded.out_of_reach(craft_.member(member)->descriptor()))
      craft_.tell(craft_.name_of(member) + " comes back without " + parameter + ": it is set in Operational only",
                  member);
    if (commanded.state() != State::Offline) means_.commanded.want(member, std::move(commanded));
  }
  links_.merge(loss.links);
  deadline_ = craft_.now + patience;
}

void Restoration::all_stopped(std::string_view why) {
  means_.commanded.all_stopped();
  static_cast<void>(cancel(why));
}

Cancelled Restoration::cancel(std::string_view why) {
  losses_.clear();
  if (means_.commanded.wanted().empty()) return Cancelled::Nothing;
  craft_.tell(fmt::format("{} not brought back: {}", names(), why), supervisor_apid);
  for (const auto& [apid, commanded] : means_.commanded.wanted())
    own_.announce("NOT_RESTORED", {static_cast<double>(apid)});
  runner_.cancel();
  means_.commanded.forget_wanted();
  links_.clear();
  return Cancelled::Ended;
}

void Restoration::watch(TimePoint now) {
  if (means_.commanded.wanted().empty()) return;
  if (const std::string why = against(); !why.empty()) return static_cast<void>(cancel(why));
  if (runner_.running()) return;
  if (now > deadline_) return static_cast<void>(cancel("they were not ready in time"));
  if (ready()) begin();
}

std::string Restoration::against() const {
  if (craft_.shutting_down) return "shutdown";
  if (under_way_.running()) return "the mode changes";
  if (const auto apid = means_.commanded.overruled()) return craft_.name_of(*apid) + " was commanded otherwise";
  return runner_.running() ? stopped() : std::string{};
}

std::string Restoration::stopped() const {
  for (const auto& [apid, commanded] : means_.commanded.wanted()) {
    if (craft_.member(apid)->recovery.running()) return "a recovery of " + craft_.name_of(apid);
    const auto fences = fences_.find(apid);
    if (fences != fences_.end() && craft_.guard.fences(apid) != fences->second)
      return craft_.name_of(apid) + " was stopped";
  }
  return {};
}

bool Restoration::ready() const {
  return std::ranges::all_of(means_.commanded.wanted(), [this](const auto& entry) {
    const Member& member = *craft_.member(entry.first);
    return member.alive() && member.state() && !is_transient(*member.state()) &&
           member.state() != State::PostOperational && !member.recovery.running() && !member.closed_at;
  });
}

void Restoration::begin() {
  WayThere way;
  std::set<std::uint16_t> there;  // or on the way
  for (const auto& [apid, commanded] : means_.commanded.wanted()) {
    const Member& member = *craft_.member(apid);
    const Present from{member.state(), member.configuration()};
    fences_[apid] = craft_.guard.fences(apid);
    there.insert(apid);
    if (from.state == commanded.state() && from.configuration == commanded.configuration()) continue;
    const auto* configuration = member.descriptor().find_configuration(commanded.configuration());
    if (configuration == nullptr) way.initialise(member.descriptor(), from);
    else way.add(member.descriptor(), *configuration, from, commanded.state());
    way.recall(apid, commanded.state());
  }
  // Who went on without may do so in another configuration by now: its own ends of links are made with that.
  const auto is_there = [&](const std::string& name, const auto& sets_of, const std::string& set) {
    const Member& member = *craft_.member(craft_.mission.find_subsystem(name)->subsystem.id);
    if (there.contains(member.apid())) return true;
    const auto* configuration = member.descriptor().find_configuration(member.configuration());
    return configuration != nullptr &&
           std::ranges::any_of(sets_of(*configuration), [&](const auto& each) { return each.name == set; });
  };
  const auto provides = [](const descriptor::Configuration& one) -> const auto& { return one.provides; };
  const auto requires_of = [](const descriptor::Configuration& one) -> const auto& { return one.requires_; };
  for (const std::uint8_t id : links_) {
    const descriptor::MissionLink& link = *craft_.mission.find_link(id);
    if (!means_.links.is_up(id) && is_there(link.from, provides, link.provides) &&
        is_there(link.to, requires_of, link.requires_))
      way.link(id);
  }
  craft_.tell(names() + ": back to the commanded state", supervisor_apid);
  runner_.start({.stages = way.stages(),
                 .finished = [this](const ProcedureEnd& end) { ended(end); },
                 .begins =
                     [this](std::size_t) {
                       if (const std::string why = against(); !why.empty()) static_cast<void>(cancel(why));
                     },
                 .knows_of_no_stop = true});
}

void Restoration::ended(const ProcedureEnd& end) {
  if (!end.success) return static_cast<void>(cancel(end.text()));
  // Its last step was done, and somebody has stopped it since: it is not as commanded.
  if (const std::string why = stopped(); !why.empty()) return static_cast<void>(cancel(why));
  craft_.tell(names() + ": as commanded", supervisor_apid);
  for (const auto& [apid, commanded] : means_.commanded.wanted())
    own_.announce("RESTORED", {static_cast<double>(apid), static_cast<double>(commanded.state())});
  means_.commanded.forget_wanted();
  links_.clear();
}

std::string Restoration::names() const {
  std::vector<std::string> all;
  for (const auto& [apid, commanded] : means_.commanded.wanted()) all.push_back(craft_.name_of(apid));
  return fmt::format("{}", fmt::join(all, ", "));
}

}  // namespace hirosco::supervisor
