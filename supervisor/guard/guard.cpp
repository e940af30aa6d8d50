// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/guard.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/utilities/os/life.hpp"

namespace hirosco::supervisor {
namespace {

/// Findings that nobody takes are those of a supervisor that stands still: the first tell the story, and beyond them each that was not told
/// yet, once.
constexpr std::size_t most_findings = 1024;

}  // namespace

GuardedMember* Guard::find(std::uint16_t apid) noexcept {
  return const_cast<GuardedMember*>(std::as_const(*this).find(apid));
}

const GuardedMember* Guard::find(std::uint16_t apid) const noexcept {
  const auto found = std::ranges::find(members_, apid, &GuardedMember::apid);
  return found != members_.end() ? &*found : nullptr;
}

// --- the supervisor's loop ---------------------------------------------------------------------------------------------

Result<> Guard::add(const descriptor::MissionSubsystem& described, bool spared) {
  GuardedMember member;
  member.described = &described;
  member.spared = spared;
  member.epoch = parts_.first_epoch;
  for (const std::string_view name : descriptor::actuators_without_enable(described.subsystem))
    member.not_asked.emplace_back(name);
  for (std::uint16_t place = 0; const descriptor::Device& device : described.subsystem.devices) {
    const std::uint16_t own_place = place++;
    member.rest_within = std::max(member.rest_within, device.stop_within);
    if (!device.enable) continue;
    HIROSCO_TRY_LET(auto flow, parts_.flows.open(held_address(*device.enable), FlowSide::Subsystem));
    WatchedDevice watched;
    watched.name = device.name;
    watched.place = own_place;
    watched.flow = std::move(flow);
    watched.stop_within = device.stop_within;
    watched.note = parts_.notes.of(described.subsystem.id, device.name);
    if (watched.note != nullptr) watched.sequence = watched.note->sequence.load(std::memory_order_acquire);
    member.devices.push_back(std::move(watched));
  }
  for (const descriptor::PowerSwitch& power : described.subsystem.power_switches) {
    HIROSCO_TRY_LET(auto flow, parts_.flows.open(held_address(power.endnode), FlowSide::Subsystem));
    member.power.add(std::move(flow));
  }
  const LockGuard lock{mutex_};
  findings_.reserve(most_findings);
  members_.push_back(std::move(member));
  for (GuardedMember& each : members_) each.had_then.resize(members_.size());
  return ok();
}

bool Guard::holds(std::uint16_t apid) const {
  const LockGuard lock{mutex_};
  return find(apid) != nullptr;
}

void Guard::adopt(std::uint16_t apid, const LaunchedSubsystem& launched) {
  const LockGuard lock{mutex_};
  GuardedMember* member = find(apid);
  if (member == nullptr || launched.vital.octets.size() < sizeof(VitalPage) ||
      launched.permit.octets.size() < sizeof(PermitPage))
    return;
  member->vital_memory = launched.vital;
  member->permit_memory = launched.permit;
  member->vital = reinterpret_cast<const VitalPage*>(launched.vital.octets.data());
  member->permit = reinterpret_cast<PermitPage*>(launched.permit.octets.data());
  member->grip = launched.grip;
  member->taken = GuardedMember::Taken::Nothing;
  member->guarded_before = false;
  // A device may have heard of every epoch of the process before.
  member->permit->epoch.store(++member->epoch, std::memory_order_release);
  // One that a guard before had given is written on it.
  put_newest_stop(std::max(newest_stop(), member->permit->newest_stop.load(std::memory_order_acquire)));
  member->stopped_in = newest_stop();
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
  // What was found of the process before is no matter of this one.
  std::erase_if(findings_, [&](const GuardFinding& finding) {
    return finding.apid == apid && finding.kind == GuardFinding::Kind::Ended;
  });
  lives_changed();
}

std::string_view Guard::take_over(std::uint16_t apid, const AdoptedSubsystem& adopted, std::string_view against) {
  adopt(apid, adopted.launched);
  const LockGuard lock{mutex_};
  GuardedMember* member = find(apid);
  if (member == nullptr || member->permit == nullptr) return "it has no pages";
  // An epoch that neither permits nor is the one that it looks at is one that nobody wrote, or damaged: no device would hear of it.
  const bool counts = adopted.permitted || adopted.epoch == member->vital->seen_epoch.load(std::memory_order_acquire);
  member->epoch = counts ? adopted.epoch : std::max(adopted.epoch, parts_.first_epoch);
  PermitPage& page = *member->permit;
  page.epoch.store(member->epoch, std::memory_order_release);
  page.powered.store(adopted.powered, std::memory_order_release);
  member->guarded_before = true;
  member->power_unknown = adopted.powered != power_off;
  const std::string_view rests = member->why_it_rests();
  member->service_moved = watched_at(parts_.clock.now());
  page.stop.store(adopted.stopped ? 1 : 0, std::memory_order_release);
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
  member->released_at = watched_at(parts_.clock.now());
  return {};
}

void Guard::ended_before(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  if (GuardedMember* member = find(apid); member != nullptr && member->vital == nullptr) member->power_unknown = true;
}

bool Guard::has_stopped_by_itself(std::uint16_t apid) const {
  const LockGuard lock{mutex_};
  const GuardedMember* member = find(apid);
  return member != nullptr && member->released && std::ranges::any_of(member->devices, [](const WatchedDevice& device) {
           return device.heard && device.last.output != DeviceOutput::Active;
         });
}

void Guard::forget(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  GuardedMember* member = find(apid);
  if (member == nullptr) return;
  member->fence();
  member->vital = nullptr;
  member->permit = nullptr;
  member->vital_memory = member->permit_memory = {};
  member->grip.reset();
  member->doomed.reset();
  lives_changed();
}

void Guard::falls_with(std::uint16_t apid, std::vector<std::uint16_t> others) {
  const LockGuard lock{mutex_};
  if (GuardedMember* member = find(apid)) member->falls_with = std::move(others);
}

std::vector<GuardFinding> Guard::take_findings() {
  const LockGuard lock{mutex_};
  std::vector<GuardFinding> taken{findings_};
  findings_.clear();
  for (GuardedMember& member : members_) member.fence_untold = false;
  return taken;
}

void Guard::find_out(GuardFinding::Kind kind, std::uint16_t apid, std::uint16_t device) {
  const GuardFinding found{kind, apid, device};
  if (findings_.size() < most_findings || std::ranges::find(findings_, found) == findings_.end())
    findings_.push_back(found);
  if (parts_.on_finding) parts_.on_finding();
}

// --- fences ------------------------------------------------------------------------------------------------------------

std::uint64_t Guard::fence(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  GuardedMember* member = find(apid);
  if (member == nullptr) return 0;
  member->fence();
  return member->fences;
}

bool Guard::was_stopped_since(std::uint16_t apid, std::uint32_t number) const {
  const LockGuard lock{mutex_};
  const GuardedMember* member = find(apid);
  return member != nullptr && number < member->stopped_in;
}

void Guard::void_what_was_said() {
  const LockGuard lock{mutex_};
  next_stop();
}

void Guard::put_newest_stop(std::uint32_t number) noexcept {
  newest_stop_.store(number, std::memory_order_release);
  for (GuardedMember& member : members_)
    if (member.permit != nullptr) member.permit->newest_stop.store(number, std::memory_order_release);
}

/// Never 0, which is what somebody says who knows of none, nor as if there had been none.
void Guard::next_stop() noexcept { put_newest_stop(std::max(newest_stop() + 1, no_stop_yet + 1)); }

std::uint64_t Guard::fences(std::uint16_t apid) const {
  const LockGuard lock{mutex_};
  const GuardedMember* member = find(apid);
  return member != nullptr ? member->fences : 0;
}

bool Guard::fenced(std::uint16_t apid) const {
  const LockGuard lock{mutex_};
  const GuardedMember* member = find(apid);
  return member != nullptr && member->permit != nullptr && member->permit->stop.load(std::memory_order_acquire) != 0;
}

bool Guard::release(std::uint16_t apid, std::uint64_t seen_fences) {
  const LockGuard lock{mutex_};
  GuardedMember* member = find(apid);
  if (member == nullptr || member->permit == nullptr || member->fences != seen_fences || member->doomed) return false;
  // The supervisor is still to hear of what stopped it.
  if (member->fence_untold) return false;
  // What is being stopped is let go again once it has stopped; what it did then is no matter of that stop any more.
  const bool stopping = stops_ended_ != stops_ && !member->spared;
  if (stopping && !member->has_stopped()) return false;
  if (stopping) {
    member->settled = stops_;
    if (!member->stopped) member->stopped = parts_.clock.now() - member->stop_begun;
  }
  member->release(watched_at(parts_.clock.now()));
  return true;
}

std::uint32_t Guard::highest_epoch() const {
  const LockGuard lock{mutex_};
  std::uint32_t highest = parts_.first_epoch;
  for (const GuardedMember& member : members_) highest = std::max(highest, member.epoch);
  return highest;
}

// --- ends of processes -------------------------------------------------------------------------------------------------

void Guard::lives_changed() noexcept {
  changes_.fetch_add(1, std::memory_order_release);
  wake_waiters(changes_);
}

std::vector<Guard::WatchedLife> Guard::lives() const {
  const LockGuard lock{mutex_};
  std::vector<WatchedLife> living;
  for (const GuardedMember& member : members_)
    if (member.vital != nullptr && !member.life_told)
      living.push_back({member.apid(), member.vital_memory, &member.vital->life, member.life});
  return living;
}

void Guard::life_changed(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  GuardedMember* member = find(apid);
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
    if (GuardedMember* with = find(other)) with->fence_by_guard();
  find_out(GuardFinding::Kind::Ended, apid);
}

// --- the guard's own step ----------------------------------------------------------------------------------------------

TimePoint Guard::step(TimePoint now) {
  const LockGuard lock{mutex_};
  asked_ = asked_at(now);
  watched_ = watched_at(now);
  stepped_ = now;
  watch_supervisor(watched_);
  if (watched_ >= next_observation_) {
    next_observation_ = watched_ + observation_period;
    observe(watched_);
  }
  for (GuardedMember& member : members_) {
    member.end_permission(watched_);
    // Damage of its page would have all that it says refused.
    if (member.permit != nullptr) member.permit->newest_stop.store(newest_stop(), std::memory_order_relaxed);
    for (WatchedDevice& device : member.devices) {
      device.hear(watched_);
      // What has no power moves nothing, and cannot say so.
      const bool still = device.rests() || (!member.power.none() && member.power.said() == power_off);
      if (!member.released && still && !device.stopped) device.stopped = now - member.stop_begun;
      const bool acts = member.seen_operational && member.released && member.uses(device.place);
      if (acts && device.falls_silent(member.released_at, watched_))
        find_out(device.silence(), member.apid(), device.place);
      device.tell(member.released && !supervisor_still_, member.epoch);
    }
    member.drive_power(watched_);
    if (member.doomed) judge_doomed(member, watched_);
  }
  if (stops_ended_ != stops_) follow_stop(now);
  return now + period;
}

TimePoint Guard::watched_at(TimePoint now) const noexcept {
  if (!stepped_) return now;
  const Duration passed = now - *stepped_;
  if (passed <= most_unwatched || somebody_went_on(passed)) return watched_ + passed;
  return watched_ + most_unwatched;
}

TimePoint Guard::asked_at(TimePoint now) const noexcept {
  return stepped_ ? asked_ + std::min(now - *stepped_, most_unwatched) : now;
}

/// Half of the cycles that were due count: while the guard alone does not run, a computer may be busy.
bool Guard::somebody_went_on(Duration passed) const noexcept {
  return std::ranges::any_of(members_, [&](const GuardedMember& member) {
    const Duration sampling = member.sampling();
    if (sampling <= Duration{0} || member.vital->cycling.load(std::memory_order_acquire) == 0) return false;
    const auto went = member.vital->cycles.load(std::memory_order_acquire) - member.cycles;
    return went >= static_cast<std::uint64_t>(passed / sampling / 2 + 1);
  });
}

void Guard::watch_supervisor(TimePoint now) {
  const std::uint64_t beats = beats_.load(std::memory_order_relaxed);
  if (beats == 0) return;  // it has not begun
  if (beats != seen_beats_ || !beat_seen_) {
    seen_beats_ = beats;
    beat_seen_ = now;
    supervisor_still_ = false;
    return;
  }
  if (supervisor_still_ || now - *beat_seen_ < supervisor_limit) return;
  // Nobody permits, plans or tells any more: what moves is stopped, the ground link included.
  supervisor_still_ = true;
  next_stop();
  for (GuardedMember& member : members_) {
    member.stopped_in = newest_stop();
    member.fence_by_guard();
  }
  find_out(GuardFinding::Kind::SupervisorStill, 0);
}

}  // namespace hirosco::supervisor
