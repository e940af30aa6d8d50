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
    WatchedDevice watched;
    watched.name = device.name;
    watched.place = own_place;
    watched.silence = device.enable_terms.silence;
    watched.silence_reduced = device.enable_terms.silence_reduced;
    watched.goes_on = device.enable_terms.goes_on;
    watched.stop_within = device.stop_within;
    watched.stop = device.stop;
    HIROSCO_TRY_LET(auto flows, open_all(*device.enable, device.enable_terms));
    for (auto& flow : flows) add_way(watched, described.subsystem.id, std::move(flow));
    member.devices.push_back(std::move(watched));
  }
  for (const descriptor::PowerSwitch& power : described.subsystem.power_switches) {
    HIROSCO_TRY_LET(auto flows, open_all(power.endnode, power.terms));
    member.power.add({std::move(flows), power.terms.silence, power.terms.silence_reduced});
  }
  return member;
}

Result<std::vector<std::unique_ptr<DataFlow>>> GuardRoster::open_all(const descriptor::Endnode& preferred,
                                                                     const descriptor::HeldTerms& terms) const {
  std::vector<std::unique_ptr<DataFlow>> opened;
  HIROSCO_TRY_LET(opened.emplace_back(), flows_.open(held_address(preferred), FlowSide::Subsystem));
  for (const descriptor::Endnode& other : terms.fall_backs) {
    HIROSCO_TRY_LET(opened.emplace_back(), flows_.open(held_address(other), FlowSide::Subsystem));
  }
  return opened;
}

/// It goes on where whoever told it last has been.
void GuardRoster::add_way(WatchedDevice& device, std::uint16_t apid, std::unique_ptr<DataFlow> flow) const {
  KeptInhibit* const note = notes_.of(apid, device.name, device.ways.size());
  if (note != nullptr) {
    const std::uint32_t told = note->sequence.load(std::memory_order_acquire);
    if (device.ways.empty() || static_cast<std::int32_t>(told - device.sequence) > 0) device.sequence = told;
    if (note->enabled()) device.way = device.ways.size();
  }
  device.ways.push_back({std::move(flow), note});
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
