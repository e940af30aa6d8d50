// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/guard_roster.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::supervisor {

Result<GuardedMember> GuardRoster::open(const descriptor::MissionSubsystem& described, bool spared) const {
  GuardedMember member;
  member.described = &described;
  member.spared = spared;
  member.epoch = first_epoch_;
  for (const std::string_view name : descriptor::actuators_without_enable(described.subsystem))
    member.not_asked.emplace_back(name);
  for (std::uint16_t place = 0; const descriptor::Device& device : described.subsystem.devices) {
    const std::uint16_t own_place = place++;
    member.rest_within = std::max(member.rest_within, device.stop_within);
    if (!device.enable) continue;
    HIROSCO_TRY_LET(auto flow, flows_.open(held_address(*device.enable), FlowSide::Subsystem));
    WatchedDevice watched;
    watched.name = device.name;
    watched.place = own_place;
    watched.flow = std::move(flow);
    watched.stop_within = device.stop_within;
    watched.stop = device.stop;
    watched.note = notes_.of(described.subsystem.id, device.name);
    if (watched.note != nullptr) watched.sequence = watched.note->sequence.load(std::memory_order_acquire);
    member.devices.push_back(std::move(watched));
  }
  for (const descriptor::PowerSwitch& power : described.subsystem.power_switches) {
    HIROSCO_TRY_LET(auto flow, flows_.open(held_address(power.endnode), FlowSide::Subsystem));
    member.power.add(std::move(flow));
  }
  return member;
}

void GuardRoster::add(GuardedMember member) {
  members_.push_back(std::move(member));
  for (GuardedMember& each : members_) each.had_then.resize(members_.size());
}

GuardedMember* GuardRoster::find(std::uint16_t apid) noexcept {
  return const_cast<GuardedMember*>(std::as_const(*this).find(apid));
}

const GuardedMember* GuardRoster::find(std::uint16_t apid) const noexcept {
  const auto found = std::ranges::find(members_, apid, &GuardedMember::apid);
  return found != members_.end() ? &*found : nullptr;
}

std::uint32_t GuardRoster::highest_epoch() const noexcept {
  std::uint32_t highest = first_epoch_;
  for (const GuardedMember& member : members_) highest = std::max(highest, member.epoch);
  return highest;
}

}  // namespace hirosco::supervisor
