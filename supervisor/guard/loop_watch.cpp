// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/loop_watch.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::supervisor {
namespace {

/// It may show that it moves again, for which it has the time in which somebody could see that; a page that was overwritten is believed no more.
[[nodiscard]] bool has_way_back(GuardFinding::Kind doom) noexcept {
  return doom == GuardFinding::Kind::CycleHangs || doom == GuardFinding::Kind::ServiceHangs;
}

}  // namespace

void LoopWatch::step(TimePoint now) {
  if (now >= next_observation_) {
    next_observation_ = now + guard_observation_period;
    observe(now);
  }
}

void LoopWatch::observe(TimePoint now) {
  for (GuardedMember& member : parts_.guarded.members()) {
    if (member.vital == nullptr || member.doomed) continue;
    if (member.damaged()) {
      doom(member, GuardFinding::Kind::PageDamaged, now);
      continue;
    }
    observe_cycle(member, now);
    if (!member.doomed) observe_service(member, now);
  }
}

void LoopWatch::observe_cycle(GuardedMember& member, TimePoint now) {
  if (member.vital->cycling.load(std::memory_order_acquire) == 0) {
    member.still = 0;
    return;
  }
  const std::uint64_t cycles = member.vital->cycles.load(std::memory_order_acquire);
  const bool moves = cycles != std::exchange(member.cycles, cycles);
  // Who was adopted looks at the page before until its service loop has read of the new one: for how long it may is not the cycle's
  // concern (Adoption::longest_change), and a page that is on its way is none that is damaged.
  const bool looks = member.page_on_its_way || member.vital->seen_epoch.load(std::memory_order_acquire) == member.epoch;
  if (moves && looks) {
    member.still = 0;
    return;
  }
  if (member.still++ == 0 && member.grip) member.processor_time = member.grip->processor_time();
  if (member.still < member.hang_limit()) return;
  // A cycle that goes on and does not see what it is permitted looks somewhere else (hazard SF13).
  if (moves) return doom(member, GuardFinding::Kind::PageDamaged, now);
  GuardedMember& culprit = spinner(member);
  for (GuardedMember& other : parts_.guarded.members()) other.still = 0;  // who waited for the processor starts anew
  doom(culprit, GuardFinding::Kind::CycleHangs, now);
}

/// All cycles of a node share one processor (adr 0007): of those that stand still it is the one that has had it.
GuardedMember& LoopWatch::spinner(GuardedMember& standing) {
  GuardedMember* most = &standing;
  double most_share = 0;
  for (GuardedMember& member : parts_.guarded.members()) {
    if (member.still == 0 || member.vital == nullptr || member.doomed || !member.grip) continue;
    const Duration had = member.grip->processor_time() - member.processor_time;
    const double share =
        static_cast<double>(had.count()) / static_cast<double>((member.still * guard_observation_period).count());
    if (share > most_share) {
      most_share = share;
      most = &member;
    }
  }
  constexpr double spins = 0.5;
  return most_share >= spins ? *most : standing;
}

void LoopWatch::observe_service(GuardedMember& member, TimePoint now) {
  const std::uint64_t steps = member.vital->service_steps.load(std::memory_order_acquire);
  if (steps == 0) return;  // it has not begun
  if (steps != std::exchange(member.service_steps, steps)) {
    member.service_moved = now;
    member.asked_who_runs.reset();
    return;
  }
  const auto state = member.state();
  const Duration limit = state && is_transient(*state) ? transient_service_limit : service_limit;
  const Duration stood = now - member.service_moved;
  // It is asked late, as it costs more than a look at a page.
  if (stood >= limit / 2 && !member.asked_who_runs) look_who_runs(member, now);
  if (stood < limit) return;
  if (!was_starved(member, now)) return doom(member, GuardFinding::Kind::ServiceHangs, now);
  member.service_moved = now;
  member.asked_who_runs.reset();
}

void LoopWatch::look_who_runs(GuardedMember& standing, TimePoint now) noexcept {
  const auto members = parts_.guarded.members();
  standing.asked_who_runs = now;
  for (std::size_t i = 0; i < members.size(); ++i)
    standing.had_then[i] = members[i].grip ? members[i].grip->loop_time() : LoopTime{};
}

/// A service loop that wants the processor and does not get it stands still for no fault of its own: the loops that have had it
/// instead lose their real-time priority. One that waits for something else, or runs, has nobody else to blame.
bool LoopWatch::was_starved(GuardedMember& standing, TimePoint now) {
  if (!standing.grip) return false;
  const auto share = [span = now - *standing.asked_who_runs](Duration had, Duration before) {
    return static_cast<double>((had - before).count()) / static_cast<double>(std::max(span, guard_period).count());
  };
  constexpr double hardly = 0.1, mostly = 0.5;
  const auto members = parts_.guarded.members();
  const auto at = static_cast<std::size_t>(&standing - members.data());
  const LoopTime own = standing.grip->loop_time();
  if (!own.runnable || share(own.service, standing.had_then[at].service) > hardly) return false;
  bool starved = false;
  for (std::size_t i = 0; i < members.size(); ++i) {
    GuardedMember& other = members[i];
    if (i == at || other.vital == nullptr || other.doomed || !other.grip) continue;
    if (share(other.grip->loop_time().realtime, standing.had_then[i].realtime) < mostly) continue;
    starved = true;
    // One that has lost it once and has it again took it by itself: it is ended.
    if (other.taken != GuardedMember::Taken::Nothing) {
      doom(other, GuardFinding::Kind::Starves, now);
      continue;
    }
    other.take_realtime(GuardedMember::Taken::Loops);
    parts_.findings.find_out(GuardFinding::Kind::Starves, other.apid());
  }
  return starved;
}

void LoopWatch::doom(GuardedMember& member, GuardFinding::Kind why, TimePoint now) {
  member.fence_by_guard();
  // One that merely stands (SIGSTOP) keeps its priority: it takes nothing from anybody.
  const Duration had = member.grip ? member.grip->processor_time() - member.processor_time : Duration{};
  if (member.grip && (why != GuardFinding::Kind::CycleHangs || had >= guard_observation_period))
    member.take_realtime(GuardedMember::Taken::All);
  member.doomed = (has_way_back(why) ? now - parts_.time.watched() + parts_.time.asked() : now) + grace;
  member.doom = why;
  parts_.findings.find_out(why, member.apid());
}

void LoopWatch::judge_doomed(GuardedMember& member, TimePoint now) {
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
    member.asked_who_runs.reset();
    return parts_.findings.find_out(GuardFinding::Kind::Back, member.apid());
  }
  if ((has_way_back(member.doom) ? parts_.time.asked() : now) < *member.doomed || member.killed) return;
  member.killed = true;
  if (member.grip) member.grip->kill();
  parts_.findings.find_out(GuardFinding::Kind::Killed, member.apid());
}

}  // namespace hirosco::supervisor
