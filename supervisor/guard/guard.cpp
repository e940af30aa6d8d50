// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/guard.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace hirosco::supervisor {
namespace {

/// From the order to stop until the last answer of a device that has nothing to wind down: its own cycle, an enable
/// command, and a busy computer.
constexpr Duration answer_limit = std::chrono::milliseconds{250};
/// From the end of a member to the answer of its devices (hazard SF2).
constexpr Duration killed_limit = std::chrono::milliseconds{400};
/// Findings that nobody takes are those of a supervisor that stands still; the first tell the story.
constexpr std::size_t most_findings = 1024;

/// Damage of the page neither lowers an epoch, so that devices would not hear of it, nor uses up those that are left.
void restore_epoch(PermitPage& page, std::uint32_t epoch) noexcept {
  if (page.epoch.load(std::memory_order_relaxed) == epoch) return;
  page.go.store(0, std::memory_order_release);
  page.epoch.store(epoch, std::memory_order_release);
}

}  // namespace

// --- one member --------------------------------------------------------------------------------------------------------

std::optional<State> Guard::Watched::state() const noexcept {
  if (vital == nullptr) return std::nullopt;
  const std::uint32_t number = vital->state.load(std::memory_order_acquire);
  if (number > static_cast<std::uint32_t>(State::SoftwareDeinit)) return std::nullopt;
  return static_cast<State>(number);
}

bool Guard::Watched::damaged() const noexcept {
  constexpr auto relaxed = std::memory_order_relaxed;
  // What it demands and how often it cycles follows from its configuration: one that nobody declared is none.
  const std::uint32_t id = vital->configuration.load(relaxed);
  const auto declared = [&](const descriptor::Configuration& configuration) { return configuration.id == id; };
  const bool known = id == 0 || std::ranges::any_of(described->subsystem.configurations, declared);
  // Nobody but the guard writes what gates: where it finds something else than it wrote, that page is believed no more.
  const std::uint64_t go = permit->go.load(relaxed);
  const bool gate = permit->magic == page_magic && permit->version == page_version &&
                    permit->epoch.load(relaxed) == epoch && (go == 0 || (released && go == permission_word(epoch)));
  return vital->magic != page_magic || vital->version != page_version || !state() || vital->cycling.load(relaxed) > 1 ||
         vital->realtime.load(relaxed) > 1 || !known || !gate;
}

bool Guard::Watched::stands_fenced() const noexcept {
  constexpr auto relaxed = std::memory_order_relaxed;
  return !released && permit != nullptr && permit->stop.load(relaxed) != 0 && permit->go.load(relaxed) == 0 &&
         permit->epoch.load(relaxed) == epoch;
}

/// A slow cycle stands still between its steps: three of its own periods are granted.
Duration Guard::Watched::slow_steps() const noexcept {
  if (vital == nullptr) return {};
  const auto id = static_cast<std::uint8_t>(vital->configuration.load(std::memory_order_relaxed));
  const auto* configured = described->subsystem.find_configuration(id);
  return configured != nullptr ? 3 * configured->sampling : Duration{};
}

std::uint32_t Guard::Watched::hang_limit() const noexcept {
  const bool realtime = vital->realtime.load(std::memory_order_relaxed) != 0;
  const std::uint32_t limit = realtime ? described->subsystem.hang.realtime : described->subsystem.hang.reduced;
  return std::max(limit, static_cast<std::uint32_t>(slow_steps() / observation_period));
}

Guard::Watched* Guard::find(std::uint16_t apid) noexcept {
  return const_cast<Watched*>(std::as_const(*this).find(apid));
}

const Guard::Watched* Guard::find(std::uint16_t apid) const noexcept {
  const auto found = std::ranges::find(members_, apid, &Watched::apid);
  return found != members_.end() ? &*found : nullptr;
}

// --- the supervisor's loop ---------------------------------------------------------------------------------------------

Result<> Guard::add(const descriptor::MissionSubsystem& described, bool spared) {
  Watched member;
  member.described = &described;
  member.spared = spared;
  member.epoch = parts_.first_epoch;
  for (const descriptor::Device& device : described.subsystem.devices) {
    if (!device.enable) continue;
    HIROSCO_TRY_LET(auto flow,
                    parts_.flows.open({device.enable->transfer, device.enable->address}, FlowSide::Subsystem));
    Device watched;
    watched.name = device.name;
    watched.flow = std::move(flow);
    watched.stop_within = device.stop_within;
    member.devices.push_back(std::move(watched));
  }
  const LockGuard lock{mutex_};
  findings_.reserve(most_findings);
  members_.push_back(std::move(member));
  return ok();
}

void Guard::adopt(std::uint16_t apid, const LaunchedSubsystem& launched) {
  const LockGuard lock{mutex_};
  Watched* member = find(apid);
  if (member == nullptr || launched.vital.octets.size() < sizeof(VitalPage) ||
      launched.permit.octets.size() < sizeof(PermitPage))
    return;
  member->vital_memory = launched.vital;
  member->permit_memory = launched.permit;
  member->vital = reinterpret_cast<const VitalPage*>(launched.vital.octets.data());
  member->permit = reinterpret_cast<PermitPage*>(launched.permit.octets.data());
  member->grip = launched.grip;
  // A device may have heard of every epoch of the process before.
  member->permit->epoch.store(++member->epoch, std::memory_order_release);
  member->released = member->seen_operational = false;
  member->cycles = member->service_steps = 0;
  member->still = 0;
  member->doomed.reset();
  member->killed = false;
}

void Guard::forget(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  Watched* member = find(apid);
  if (member == nullptr) return;
  fence(*member);
  member->vital = nullptr;
  member->permit = nullptr;
  member->vital_memory = member->permit_memory = {};
  member->grip.reset();
  member->doomed.reset();
}

std::vector<GuardFinding> Guard::take_findings() {
  const LockGuard lock{mutex_};
  std::vector<GuardFinding> taken{findings_};
  findings_.clear();
  return taken;
}

void Guard::find_out(GuardFinding::Kind kind, std::uint16_t apid) {
  if (findings_.size() < most_findings) findings_.push_back({kind, apid});
  if (parts_.on_finding) parts_.on_finding();
}

// --- fences ------------------------------------------------------------------------------------------------------------

void Guard::fence(std::uint16_t apid) {
  const LockGuard lock{mutex_};
  if (Watched* member = find(apid)) fence(*member);
}

void Guard::fence(Watched& member) noexcept {
  ++member.fences;
  // Who stands fenced stays so: a further epoch, or a further answer to wait for, would only put off its word that it has stopped.
  if (member.stands_fenced()) return;
  member.released = false;
  if (PermitPage* page = member.permit) {
    if (member.vital != nullptr && page->stop.load(std::memory_order_relaxed) == 0)
      page->stopped_at_cycle.store(member.vital->cycles.load(std::memory_order_acquire), std::memory_order_relaxed);
    restore_epoch(*page, member.epoch);
    page->fence();
    member.epoch = page->epoch.load(std::memory_order_relaxed);
  }
  for (Device& device : member.devices) device.fenced_at_sequence = device.sequence;
}

std::uint64_t Guard::fences(std::uint16_t apid) const {
  const LockGuard lock{mutex_};
  const Watched* member = find(apid);
  return member != nullptr ? member->fences : 0;
}

bool Guard::fenced(std::uint16_t apid) const {
  const LockGuard lock{mutex_};
  const Watched* member = find(apid);
  return member != nullptr && member->permit != nullptr && member->permit->stop.load(std::memory_order_acquire) != 0;
}

bool Guard::release(std::uint16_t apid, std::uint64_t seen_fences) {
  const LockGuard lock{mutex_};
  Watched* member = find(apid);
  if (member == nullptr || member->permit == nullptr || member->fences != seen_fences || member->doomed) return false;
  // What is being stopped is let go again once it has stopped; what it did then is no matter of that stop any more.
  const bool stopping = stops_ended_ != stops_ && !member->spared;
  if (stopping && !has_stopped(*member)) return false;
  if (stopping) {
    member->settled = stops_;
    if (!member->stopped) member->stopped = parts_.clock.now() - stop_begun_;
  }
  restore_epoch(*member->permit, member->epoch);
  member->permit->release();
  member->epoch = member->permit->epoch.load(std::memory_order_relaxed);
  member->released = true;
  member->seen_operational = false;
  member->released_at = parts_.clock.now();
  return true;
}

std::uint64_t Guard::stop_all(GuardFinding::Kind why) {
  const std::uint64_t stop = stop_all();
  const LockGuard lock{mutex_};
  find_out(why, 0);
  return stop;
}

std::uint64_t Guard::stop_all() {
  const LockGuard lock{mutex_};
  for (Watched& member : members_) {
    if (member.spared) continue;
    if (member.released) {
      member.stopped.reset();
      for (Device& device : member.devices) device.stopped.reset();
    }
    fence(member);
  }
  // Stops that overlap end together; their time runs from the first.
  if (stops_ended_ == stops_) {
    stop_begun_ = parts_.clock.now();
    for (Watched& member : members_) {
      member.stop_killed = false;
      member.stopped.reset();
      for (Device& device : member.devices) device.stopped.reset();
    }
  }
  return ++stops_;
}

std::optional<std::vector<StopAnswer>> Guard::stop_outcome(std::uint64_t stop) const {
  const LockGuard lock{mutex_};
  if (stop > stops_ended_) return std::nullopt;
  std::vector<StopAnswer> answers;
  for (const Watched& member : members_) {
    if (member.spared) continue;
    const std::string& name = member.described->subsystem.name;
    for (const Device& device : member.devices)
      answers.push_back({member.apid(), device.name, true, device.stopped, member.stop_killed});
    if (member.devices.empty()) answers.push_back({member.apid(), name, false, member.stopped, member.stop_killed});
  }
  return answers;
}

std::uint32_t Guard::highest_epoch() const {
  const LockGuard lock{mutex_};
  std::uint32_t highest = parts_.first_epoch;
  for (const Watched& member : members_) highest = std::max(highest, member.epoch);
  return highest;
}

// --- the guard's own step ----------------------------------------------------------------------------------------------

TimePoint Guard::step(TimePoint now) {
  const LockGuard lock{mutex_};
  watch_supervisor(now);
  if (now >= next_observation_) {
    next_observation_ = now + observation_period;
    observe(now);
  }
  for (Watched& member : members_) {
    end_permission(member, now);
    tell_devices(member, now);
    if (member.doomed) judge_doomed(member, now);
  }
  if (stops_ended_ != stops_) follow_stop(now);
  return now + period;
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
  for (Watched& member : members_) fence(member);
  find_out(GuardFinding::Kind::SupervisorStill, 0);
}

void Guard::observe(TimePoint now) {
  for (Watched& member : members_) {
    if (member.vital == nullptr || member.doomed) continue;
    if (member.damaged()) {
      doom(member, GuardFinding::Kind::PageDamaged, now);
      continue;
    }
    observe_cycle(member, now);
    if (!member.doomed) observe_service(member, now);
  }
}

void Guard::observe_cycle(Watched& member, TimePoint now) {
  if (member.vital->cycling.load(std::memory_order_acquire) == 0) {
    member.still = 0;
    return;
  }
  const std::uint64_t cycles = member.vital->cycles.load(std::memory_order_acquire);
  const bool moves = cycles != std::exchange(member.cycles, cycles);
  const bool looks = member.vital->seen_epoch.load(std::memory_order_acquire) == member.epoch;
  if (moves && looks) {
    member.still = 0;
    return;
  }
  if (member.still++ == 0 && member.grip) member.processor_time = member.grip->processor_time();
  if (member.still < member.hang_limit()) return;
  // A cycle that goes on and does not see what it is permitted looks somewhere else (hazard SF13).
  if (moves) return doom(member, GuardFinding::Kind::PageDamaged, now);
  Watched& culprit = spinner(member);
  for (Watched& other : members_) other.still = 0;  // who waited for the processor starts anew
  doom(culprit, GuardFinding::Kind::CycleHangs, now);
}

/// All cycles of a node share one processor (adr 0007): of those that stand still it is the one that has had it.
Guard::Watched& Guard::spinner(Watched& standing) {
  Watched* most = &standing;
  double most_share = 0;
  for (Watched& member : members_) {
    if (member.still == 0 || member.vital == nullptr || member.doomed || !member.grip) continue;
    const Duration had = member.grip->processor_time() - member.processor_time;
    const double share =
        static_cast<double>(had.count()) / static_cast<double>((member.still * observation_period).count());
    if (share > most_share) {
      most_share = share;
      most = &member;
    }
  }
  constexpr double spins = 0.5;
  return most_share >= spins ? *most : standing;
}

void Guard::observe_service(Watched& member, TimePoint now) {
  const std::uint64_t steps = member.vital->service_steps.load(std::memory_order_acquire);
  if (steps == 0) return;  // it has not begun
  if (steps != std::exchange(member.service_steps, steps)) {
    member.service_moved = now;
    return;
  }
  const auto state = member.state();
  const Duration limit = state && is_transient(*state) ? transient_service_limit : service_limit;
  if (now - member.service_moved >= limit) doom(member, GuardFinding::Kind::ServiceHangs, now);
}

void Guard::doom(Watched& member, GuardFinding::Kind why, TimePoint now) {
  fence(member);
  // One that merely stands (SIGSTOP) keeps its priority: it takes nothing from anybody.
  const Duration had = member.grip ? member.grip->processor_time() - member.processor_time : Duration{};
  if (member.grip && (why != GuardFinding::Kind::CycleHangs || had >= observation_period)) member.grip->take_realtime();
  member.doomed = now + grace;
  member.doom = why;
  find_out(why, member.apid());
}

void Guard::judge_doomed(Watched& member, TimePoint now) {
  bool back = false;
  switch (member.doom) {
    case GuardFinding::Kind::CycleHangs:
      back = member.vital->cycling.load(std::memory_order_acquire) == 0 ||
             member.vital->cycles.load(std::memory_order_acquire) != member.cycles;
      break;
    case GuardFinding::Kind::ServiceHangs:
      back = member.vital->service_steps.load(std::memory_order_acquire) != member.service_steps;
      break;
    default: break;  // a page that was overwritten is believed no more
  }
  if (back) {
    member.doomed.reset();
    member.still = 0;
    member.service_moved = now;
    return find_out(GuardFinding::Kind::Back, member.apid());
  }
  if (now < *member.doomed || member.killed) return;
  member.killed = true;
  if (member.grip) member.grip->kill();
  find_out(GuardFinding::Kind::Killed, member.apid());
}

/// A permission is for one stay in Operational: it ends with it.
void Guard::end_permission(Watched& member, TimePoint now) noexcept {
  if (!member.released) return;
  const bool operational = member.state() == State::Operational;
  member.seen_operational = member.seen_operational || operational;
  const bool over = member.seen_operational ? !operational : now - member.released_at >= entry_limit;
  if (!over) return;
  member.released = false;
  if (member.permit != nullptr) member.permit->go.store(0, std::memory_order_release);
}

void Guard::tell_devices(Watched& member, TimePoint now) noexcept {
  std::array<std::byte, enable_frame_octets> frame;
  for (Device& device : member.devices) {
    const auto received = device.flow->receive(frame);
    if (received && received->flow == Flow::New) {
      if (const auto status = read_enable_status(Octets{frame}.first(std::min(received->octets, frame.size())))) {
        device.last = *status;
        device.heard = true;
      }
    }
    const bool knows = device.heard && static_cast<std::int32_t>(device.last.sequence - device.fenced_at_sequence) > 0;
    const bool at_rest = device.last.output == DeviceOutput::Off || device.last.output == DeviceOutput::Holding;
    if (!member.released && knows && at_rest && !device.stopped) device.stopped = now - stop_begun_;
    const bool enabled = member.released && !supervisor_still_;
    const auto written = write_enable_command(
        frame,
        {.enabled = static_cast<std::uint8_t>(enabled ? 1 : 0), .epoch = member.epoch, .sequence = ++device.sequence});
    // A device that does not hear it stops by itself: that is what it waits for.
    if (written) static_cast<void>(device.flow->send(*written));
  }
}

Duration Guard::stop_limit(const Watched& member) const noexcept {
  Duration longest{};
  for (const Device& device : member.devices) longest = std::max(longest, device.stop_within);
  // Its own word comes with its cycle.
  return std::max(longest, member.slow_steps()) + answer_limit;
}

bool Guard::has_stopped(const Watched& member) const noexcept {
  if (!member.devices.empty())
    return std::ranges::all_of(member.devices, [](const Device& device) { return device.stopped.has_value(); });
  return says_stopped(member);
}

/// Its own word: that of its page.
bool Guard::says_stopped(const Watched& member) const noexcept {
  if (member.vital == nullptr) return true;  // there is no process that could move anything
  const auto state = member.state();
  if (!state) return false;  // what a damaged page says is nothing
  if (*state == State::Offline) return true;
  const bool rests = member.vital->cycling.load(std::memory_order_acquire) == 0;
  const bool knows = member.vital->seen_epoch.load(std::memory_order_acquire) == member.epoch;
  const bool inhibited = *state != State::Operational || member.vital->inhibited.load(std::memory_order_acquire) != 0;
  return rests || (knows && inhibited);
}

/// A device that cannot be heard (unplugged, say) is no reason to end the subsystem that has let go of it.
bool Guard::to_blame(const Watched& member) const noexcept {
  const auto moves = [](const Device& device) {
    const bool knows = device.heard && static_cast<std::int32_t>(device.last.sequence - device.fenced_at_sequence) > 0;
    return knows && !device.stopped;
  };
  return !says_stopped(member) || std::ranges::any_of(member.devices, moves);
}

void Guard::follow_stop(TimePoint now) {
  bool waiting = false;
  for (Watched& member : members_) {
    if (member.spared || member.settled == stops_) continue;
    if (has_stopped(member)) {
      if (!member.stopped) member.stopped = now - stop_begun_;
      continue;
    }
    member.stopped.reset();
    const Duration since = now - stop_begun_;
    if (since >= stop_limit(member) && !member.stop_killed && member.grip && to_blame(member)) {
      member.stop_killed = true;
      member.grip->kill();
      find_out(GuardFinding::Kind::Killed, member.apid());
    }
    waiting = waiting || since < stop_limit(member) + (member.stop_killed ? killed_limit : Duration{0});
  }
  if (waiting) return;
  stops_ended_ = stops_;
  if (parts_.on_finding) parts_.on_finding();
}

}  // namespace hirosco::supervisor
