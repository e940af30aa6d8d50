// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/mode_plan.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>

#include "supervisor/supervision/procedures/steps/way_there.hpp"

namespace hirosco::supervisor {

using descriptor::State;

namespace {

/// Where a mode wants a member; without configuration: Offline.
struct Target {
  const descriptor::Configuration* configuration{nullptr};
  State state{State::Offline};
};

[[nodiscard]] std::uint16_t apid_of(const Craft& craft, const std::string& name) {
  return craft.mission.find_subsystem(name)->subsystem.id;
}

[[nodiscard]] bool holds(const Craft& craft, const descriptor::Interlock& interlock) {
  const Member* member = craft.member(apid_of(craft, interlock.subsystem));
  if (member == nullptr || !member->state()) return false;
  if (std::ranges::find(interlock.states, *member->state()) == interlock.states.end()) return false;
  if (interlock.configuration.empty()) return true;
  const auto* wanted = member->descriptor().find_configuration(interlock.configuration);
  return wanted != nullptr && member->configuration() == wanted->id;
}

/// Empty: it is left where it is, as the ground link in a mode that does not name it.
[[nodiscard]] std::optional<Target> target_of(const Craft& craft, const descriptor::Mode& mode, const Member& member) {
  const descriptor::SubsystemDescriptor& subsystem = member.descriptor();
  const auto named = std::ranges::find(mode.commission, subsystem.name, &descriptor::CommissionStep::subsystem);
  if (named != mode.commission.end()) return Target{subsystem.find_configuration(named->configuration), named->state};
  if (craft.is_ground_link(member)) return std::nullopt;
  return Target{};
}

[[nodiscard]] bool is_there(const Member& member, const Target& target) {
  if (member.state() != target.state) return false;
  return target.configuration == nullptr || member.configuration() == target.configuration->id;
}

class Planner {
 public:
  Planner(const Craft& craft, const LinkGraph& links, const descriptor::Mode& mode)
      : craft_{craft}, links_{links}, mode_{mode} {}

  ModePlan plan(const PowerLedger& power) {
    against_ = interlocks_against(craft_, mode_, Judged::Everybody);
    if (!mode_.commission.empty()) {
      find_movers();
      check_members();
      check_power(power);
    }
    ModePlan made{.stages = {}, .moved = {}, .against = std::move(against_)};
    WayThere way;
    for (const Member& member : craft_.members) {
      if (!movers_.contains(member.apid())) continue;
      made.moved.push_back(member.apid());
      const Target target = *target_of(member);
      const Present from{member.state(), member.configuration()};
      if (target.configuration != nullptr && target.state == State::Operational) made.released.push_back(member.apid());
      if (target.configuration != nullptr) way.add(member.descriptor(), *target.configuration, from, target.state);
      else way.down(member.descriptor(), from);
    }
    for (const std::uint8_t id : mode_.establish)
      if (is_made(id)) way.link(id);
    for (Stage& stage : way.stages())
      if (!stage.empty()) made.stages.push_back(std::move(stage));
    return made;
  }

 private:
  [[nodiscard]] std::optional<Target> target_of(const Member& member) const {
    return hirosco::supervisor::target_of(craft_, mode_, member);
  }
  [[nodiscard]] bool is_wanted(std::uint8_t link) const {
    return std::ranges::find(mode_.establish, link) != mode_.establish.end();
  }
  /// Not up yet, or taken along by an end that moves.
  [[nodiscard]] bool is_made(std::uint8_t id) const {
    const auto& link = *craft_.mission.find_link(id);
    return !links_.is_up(id) || movers_.contains(apid_of(craft_, link.from)) ||
           movers_.contains(apid_of(craft_, link.to));
  }

  /// One that has nowhere to go takes part in nothing: it is left out, or told by check_members().
  void move(std::uint16_t apid) {
    const Member* member = craft_.member(apid);
    if (member != nullptr && member->alive() && target_of(*member)) movers_.insert(apid);
  }

  void find_movers() {
    for (const Member& member : craft_.members)
      if (const auto target = target_of(member); target && !is_there(member, *target)) move(member.apid());
    for (const descriptor::MissionLink& link : craft_.mission.links) {
      const bool changes = is_wanted(link.id) ? !links_.is_up(link.id) : links_.is_held(link.id);
      if (!changes) continue;
      move(apid_of(craft_, link.from));
      move(apid_of(craft_, link.to));
    }
    // Who gives its links back takes down those who need them: a network moves as a whole, the one that there is and the one to be.
    for (std::size_t before = 0; before != movers_.size();) {
      before = movers_.size();
      for (const std::uint16_t apid : std::set{movers_})
        for (const std::uint16_t other : links_.network_of(apid)) move(other);
      for (const std::uint8_t id : mode_.establish) {
        const auto& link = *craft_.mission.find_link(id);
        const std::uint16_t from = apid_of(craft_, link.from), to = apid_of(craft_, link.to);
        if (movers_.contains(from)) move(to);
        if (movers_.contains(to)) move(from);
      }
    }
    // Who is Offline and is to be so has nothing to do in that.
    std::erase_if(movers_, [&](std::uint16_t apid) {
      const Member* member = craft_.member(apid);
      return target_of(*member)->configuration == nullptr && member->state() == State::Offline;
    });
  }

  void check_members() {
    for (const Member& member : craft_.members) {
      const auto target = target_of(member);
      if (!target) continue;
      const std::string& name = member.descriptor().name;
      // A mode whose members are dead is not that mode, whatever it is called (hazard SF15); who is not of it may be dead.
      if (!member.alive()) {
        if (target->configuration != nullptr) object("{} is down: SET_STATE Offline starts it again", name);
      } else if (!movers_.contains(member.apid())) {
        continue;
      } else if (member.recovery.running() || member.closed_at) {
        object("{} is in a recovery", name);
      } else if (!member.state() || is_transient(*member.state())) {
        object("{} is on its way between two states", name);
      }
    }
  }

  /// Those who are to come up, in the order of the mission, against what there is now beside those who stay and those before them, who
  /// are wanted with them: each for whom that is too little is told. A mode that brings up nobody is never refused for want of power.
  void check_power(const PowerLedger& power) {
    if (!power.limited()) return;
    const auto milliwatts = [](double watts) { return static_cast<std::uint32_t>(watts * 1000 + 0.5); };
    const auto comes_up = [&](const Member& member) {
      const auto target = target_of(member);
      return movers_.contains(member.apid()) && target && target->configuration != nullptr &&
             target->state != State::PreOperational;
    };
    std::uint64_t sum_mw = power.held_mw(supervisor_apid);
    for (const Member& member : craft_.members)
      if (!movers_.contains(member.apid())) sum_mw += power.held_mw(member.apid());
    for (const Member& member : craft_.members) {
      if (!comes_up(member)) continue;
      const std::uint32_t needs_mw = milliwatts(target_of(member)->configuration->power_w);
      const std::uint64_t free_mw = power.budget_mw() - std::min<std::uint64_t>(sum_mw, power.budget_mw());
      sum_mw += needs_mw;
      const auto& measured = craft_.mission.power_measured;
      const bool measures = measured && measured->apid == member.apid();
      if (needs_mw <= free_mw || measures || craft_.is_ground_link(member)) continue;
      object("{} needs {} W, {} W of {} W are free{}{}", member.descriptor().name, static_cast<double>(needs_mw) / 1000,
             static_cast<double>(free_mw) / 1000, power.budget_mw() / 1000.0, power.basis().empty() ? "" : ": ",
             power.basis());
    }
  }

  template <class... Values>
  void object(fmt::format_string<Values...> text, Values&&... values) {
    against_.push_back(fmt::format(text, std::forward<Values>(values)...));
  }

  const Craft& craft_;
  const LinkGraph& links_;
  const descriptor::Mode& mode_;
  std::set<std::uint16_t> movers_;
  std::vector<std::string> against_;
};

}  // namespace

std::vector<std::string> interlocks_against(const Craft& craft, const descriptor::Mode& mode, Judged judged) {
  std::vector<std::string> against;
  // Entered anew from itself it may always be: that is how what has fallen comes up again.
  if (!mode.from.empty() && craft.mode != &mode && std::ranges::find(mode.from, craft.mode->name) == mode.from.end())
    against.push_back(fmt::format("it is not entered from mode {}", craft.mode->name));
  for (const descriptor::Interlock& interlock : mode.interlocks) {
    const bool commissioned = std::ranges::find(mode.commission, interlock.subsystem,
                                                &descriptor::CommissionStep::subsystem) != mode.commission.end();
    if (commissioned && judged == Judged::WhomItDoesNotCommission) continue;
    const bool excludes = interlock.kind == descriptor::Interlock::Kind::Excludes;
    if (holds(craft, interlock) == excludes)
      against.push_back(fmt::format("it {} {}", excludes ? "excludes" : "needs", to_string(interlock)));
  }
  return against;
}

std::string missing_from(const Craft& craft, const LinkGraph& links, const descriptor::Mode& mode) {
  std::vector<std::string> missing;
  for (const Member& member : craft.members) {
    const auto target = target_of(craft, mode, member);
    if (!target || target->configuration == nullptr || is_there(member, *target)) continue;
    const std::string& name = member.descriptor().name;
    if (member.state() != target->state) missing.push_back(fmt::format("{} is not {}", name, to_text(target->state)));
    else missing.push_back(fmt::format("{} is not in configuration {}", name, target->configuration->name));
  }
  for (const std::uint8_t id : mode.establish)
    if (!links.is_up(id)) missing.push_back(fmt::format("link {} is not up", id));
  return fmt::format("{}", fmt::join(missing, "; "));
}

ModePlan plan_mode(const Craft& craft, const LinkGraph& links, const PowerLedger& power, const descriptor::Mode& mode) {
  return Planner{craft, links, mode}.plan(power);
}

}  // namespace hirosco::supervisor
