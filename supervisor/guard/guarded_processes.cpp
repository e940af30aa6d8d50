// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/guarded_processes.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/utilities/os/life.hpp"

namespace hirosco::supervisor {

void GuardedProcesses::started(std::uint16_t apid, const LaunchedSubsystem& launched) {
  GuardedMember* member = parts_.guarded.find(apid);
  if (member == nullptr || launched.vital.octets.size() < sizeof(VitalPage) ||
      launched.permit.octets.size() < sizeof(PermitPage))
    return;
  member->vital_memory = launched.vital;
  member->permit_memory = launched.permit;
  member->vital = reinterpret_cast<const VitalPage*>(launched.vital.octets.data());
  member->permit = reinterpret_cast<PermitPage*>(launched.permit.octets.data());
  member->grip = launched.grip;
  member->taken = GuardedMember::Taken::Nothing;
  member->guarded_before = member->page_on_its_way = false;
  // A device may have heard of every epoch of the process before.
  member->permit->epoch.store(++member->epoch, std::memory_order_release);
  // One that a guard before had given is written on it.
  parts_.number.put(std::max(parts_.number.newest(), member->permit->newest_stop.load(std::memory_order_acquire)));
  member->stopped_in = parts_.number.newest();
  member->released = member->seen_operational = false;
  member->cycles = member->service_steps = 0;
  member->still = 0;
  member->asked_who_runs.reset();
  member->doomed.reset();
  member->killed = false;
  for (WatchedDevice& device : member->devices) device.silence_told = false;
  member->falls_with.clear();
  member->life = 0;
  member->life_told = false;
  member->fence_untold = false;
  parts_.findings.forget_end_of(apid);
  lives_changed();
}

std::string_view GuardedProcesses::go_on(std::uint16_t apid, const AdoptedSubsystem& adopted,
                                         std::string_view against) {
  GuardedMember* member = parts_.guarded.find(apid);
  if (member == nullptr || member->permit == nullptr) return "it has no pages";
  // An epoch that neither permits nor is the one that it looks at is one that nobody wrote, or damaged: no device would hear of it.
  const bool counts = adopted.permitted || adopted.epoch == member->vital->seen_epoch.load(std::memory_order_acquire);
  member->epoch = counts ? adopted.epoch : std::max(adopted.epoch, parts_.guarded.first_epoch());
  PermitPage& page = *member->permit;
  page.epoch.store(member->epoch, std::memory_order_release);
  page.powered.store(adopted.powered, std::memory_order_release);
  member->guarded_before = member->page_on_its_way = true;
  member->power_unknown = adopted.powered != power_off;
  const std::string_view rests = member->why_it_rests();
  member->service_moved = parts_.time.watched_at(parts_.clock.now());
  // A stop beside a permission is none that was carried out: fence() does it, under an epoch that was not permitted.
  page.stop.store(adopted.stopped && !adopted.permitted ? 1 : 0, std::memory_order_release);
  if (!adopted.permitted) return "it was not permitted";
  if (const std::string_view why = adopted.stopped    ? "it was stopped"
                                   : !against.empty() ? against
                                                      : rests;
      !why.empty()) {
    member->fence();
    return why;
  }
  page.go.store(permission_word(adopted.epoch), std::memory_order_release);
  member->released = member->seen_operational = true;
  member->released_at = parts_.time.watched_at(parts_.clock.now());
  return {};
}

void GuardedProcesses::looks_at_its_page(std::uint16_t apid) noexcept {
  if (GuardedMember* member = parts_.guarded.find(apid)) member->page_on_its_way = false;
}

void GuardedProcesses::ended_before(std::uint16_t apid) {
  if (GuardedMember* member = parts_.guarded.find(apid); member != nullptr && member->vital == nullptr)
    member->power_unknown = true;
}

void GuardedProcesses::forget(std::uint16_t apid) {
  GuardedMember* member = parts_.guarded.find(apid);
  if (member == nullptr) return;
  member->fence();
  member->vital = nullptr;
  member->permit = nullptr;
  member->vital_memory = member->permit_memory = {};
  member->grip.reset();
  member->doomed.reset();
  lives_changed();
}

// --- their ends --------------------------------------------------------------------------------------------------------

void GuardedProcesses::falls_with(std::uint16_t apid, std::vector<std::uint16_t> others) {
  if (GuardedMember* member = parts_.guarded.find(apid)) member->falls_with = std::move(others);
}

void GuardedProcesses::lives_changed() noexcept {
  changes_.fetch_add(1, std::memory_order_release);
  wake_waiters(changes_);
}

std::vector<GuardedProcesses::WatchedLife> GuardedProcesses::lives() const {
  std::vector<WatchedLife> living;
  for (const GuardedMember& member : parts_.guarded.members())
    if (member.vital != nullptr && !member.life_told)
      living.push_back({member.apid(), member.vital_memory, &member.vital->life, member.life});
  return living;
}

void GuardedProcesses::life_changed(std::uint16_t apid) {
  GuardedMember* member = parts_.guarded.find(apid);
  if (member == nullptr || member->vital == nullptr || member->life_told) return;
  const std::uint32_t word = member->vital->life.load(std::memory_order_acquire);
  if (word == member->life) return;
  if (member->life == 0 && life_of(word) == Life::Held) {
    member->life = word;
    return;
  }
  member->life_told = true;
  member->fence_by_guard();
  for (const std::uint16_t other : member->falls_with)
    if (GuardedMember* with = parts_.guarded.find(other)) with->fence_by_guard();
  parts_.findings.find_out(GuardFinding::Kind::Ended, apid);
}

}  // namespace hirosco::supervisor
