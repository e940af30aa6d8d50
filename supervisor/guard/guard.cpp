// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/guard.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::supervisor {

Guard::Guard(Parts parts)
    : clock_{parts.clock},
      guarded_{parts.flows, parts.first_epoch, std::move(parts.notes)},
      findings_{std::move(parts.on_finding)},
      stop_of_all_{
          {.clock = clock_, .guarded = guarded_, .number = stop_number_, .time = time_, .findings = findings_}},
      supervisor_watch_{{.guarded = guarded_, .number = stop_number_, .findings = findings_}},
      loop_watch_{{.guarded = guarded_, .time = time_, .findings = findings_}},
      inhibit_watch_{findings_},
      processes_{{.clock = clock_, .guarded = guarded_, .number = stop_number_, .time = time_, .findings = findings_}} {
}

// --- the supervisor's loop ---------------------------------------------------------------------------------------------

Result<> Guard::add(const descriptor::MissionSubsystem& described, bool spared) {
  HIROSCO_TRY_LET(GuardedMember member, guarded_.open(described, spared));
  const LockGuard lock{mutex_};
  findings_.reserve();
  guarded_.add(std::move(member));
  return ok();
}

bool Guard::holds(std::uint16_t apid) const {
  const LockGuard lock{mutex_};
  return guarded_.find(apid) != nullptr;
}

void Guard::started(std::uint16_t apid, const LaunchedSubsystem& launched) {
  const LockGuard lock{mutex_};
  processes_.started(apid, launched);
}

std::string_view Guard::adopt(std::uint16_t apid, const AdoptedSubsystem& adopted, std::string_view against) {
  started(apid, adopted.launched);
  const LockGuard lock{mutex_};
  return processes_.go_on(apid, adopted, against);
}

void Guard::looks_at_its_page(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  processes_.looks_at_its_page(apid);
}

void Guard::ended_before(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  processes_.ended_before(apid);
}

bool Guard::has_stopped_by_itself(std::uint16_t apid) const {
  const LockGuard lock{mutex_};
  const GuardedMember* member = guarded_.find(apid);
  return member != nullptr && member->released && std::ranges::any_of(member->devices, [](const WatchedDevice& device) {
           return device.heard && device.last.output != DeviceOutput::Active;
         });
}

void Guard::forget(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  processes_.forget(apid);
}

void Guard::falls_with(std::uint16_t apid, std::vector<std::uint16_t> others) {
  const LockGuard lock{mutex_};
  processes_.falls_with(apid, std::move(others));
}

std::vector<GuardFinding> Guard::take_findings() {
  const LockGuard lock{mutex_};
  std::vector<GuardFinding> taken = findings_.take();
  for (GuardedMember& member : guarded_.members()) member.fence_untold = false;
  return taken;
}

// --- fences ------------------------------------------------------------------------------------------------------------

std::uint64_t Guard::fence(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  GuardedMember* member = guarded_.find(apid);
  if (member == nullptr) return 0;
  member->fence();
  return member->fences;
}

bool Guard::was_stopped_since(std::uint16_t apid, std::uint32_t number) const {
  const LockGuard lock{mutex_};
  const GuardedMember* member = guarded_.find(apid);
  return member != nullptr && number < member->stopped_in;
}

void Guard::void_what_was_said() {
  const LockGuard lock{mutex_};
  stop_number_.next();
}

std::uint64_t Guard::fences(std::uint16_t apid) const {
  const LockGuard lock{mutex_};
  const GuardedMember* member = guarded_.find(apid);
  return member != nullptr ? member->fences : 0;
}

bool Guard::fenced(std::uint16_t apid) const {
  const LockGuard lock{mutex_};
  const GuardedMember* member = guarded_.find(apid);
  return member != nullptr && member->permit != nullptr && member->permit->stop.load(std::memory_order_acquire) != 0;
}

bool Guard::release(std::uint16_t apid, std::uint64_t seen_fences) {
  const LockGuard lock{mutex_};
  GuardedMember* member = guarded_.find(apid);
  if (member == nullptr || member->permit == nullptr || member->fences != seen_fences || member->doomed) return false;
  // The supervisor is still to hear of what stopped it.
  if (member->fence_untold) return false;
  if (!stop_of_all_.lets_go(*member)) return false;
  member->release(time_.watched_at(clock_.now()));
  return true;
}

std::uint64_t Guard::stop_all(GuardFinding::Kind why) {
  const LockGuard lock{mutex_};
  return stop_of_all_.begin(why);
}

std::uint64_t Guard::stop_all() {
  const LockGuard lock{mutex_};
  return stop_of_all_.begin();
}

std::optional<std::vector<StopAnswer>> Guard::stop_outcome(std::uint64_t stop) const {
  const LockGuard lock{mutex_};
  return stop_of_all_.outcome(stop);
}

std::uint32_t Guard::highest_epoch() const {
  const LockGuard lock{mutex_};
  return guarded_.highest_epoch();
}

// --- ends of processes -------------------------------------------------------------------------------------------------

std::vector<Guard::WatchedLife> Guard::lives() const {
  const LockGuard lock{mutex_};
  return processes_.lives();
}

void Guard::life_changed(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  processes_.life_changed(apid);
}

// --- the guard's own step ----------------------------------------------------------------------------------------------

TimePoint Guard::step(TimePoint now) {
  const LockGuard lock{mutex_};
  time_.step(now);
  const TimePoint watched = time_.watched();
  supervisor_watch_.step(watched);
  loop_watch_.step(watched);
  for (GuardedMember& member : guarded_.members()) {
    member.end_permission(watched);
    stop_number_.renew(member);
    inhibit_watch_.step(member, watched);
    for (WatchedDevice& device : member.devices) {
      // What has no power moves nothing, and cannot say so; how it rests when it has some again is no matter of what it did before.
      const bool unpowered = !member.power.none() && member.power.said() == power_off;
      if (unpowered) device.acts = false;
      const bool still = device.rests() || unpowered;
      if (!member.released && still && !device.stopped) device.stopped = now - member.stop_begun;
      device.tell(member.released && !supervisor_watch_.still(), member.epoch);
    }
    member.drive_power(watched);
    if (const auto found = member.power_finding(watched)) findings_.find_out(found->kind, found->apid, found->device);
    if (member.doomed) loop_watch_.judge_doomed(member, watched);
  }
  if (stop_of_all_.under_way()) stop_of_all_.follow(now);
  return now + period;
}

}  // namespace hirosco::supervisor
