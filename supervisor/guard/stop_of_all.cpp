// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/guard.hpp"

/// The stop of everything: who is asked, and when it has ended.
namespace hirosco::supervisor {
namespace {

/// From the end of a member to the answer of its devices (hazard SF2).
constexpr Duration killed_limit = std::chrono::milliseconds{400};

}  // namespace

std::uint64_t Guard::stop_all(GuardFinding::Kind why) {
  const LockGuard lock{mutex_};
  const std::uint64_t stop = begin_stop_of_all();
  for (GuardedMember& member : members_) member.fence_untold = member.fence_untold || !member.spared;
  find_out(why, 0);
  return stop;
}

std::uint64_t Guard::stop_all() {
  const LockGuard lock{mutex_};
  return begin_stop_of_all();
}

std::uint64_t Guard::begin_stop_of_all() {
  const TimePoint now = parts_.clock.now();
  const TimePoint asked = asked_at(now);
  // Stops that overlap end together. The time of each member runs from the first that found it moving: from this one for who moves,
  // or did since the stop that is still open had seen it at rest.
  const bool first = stops_ended_ == stops_;
  next_stop();
  for (GuardedMember& member : members_) {
    if (first || member.released || member.settled == stops_) member.begin_stop(now, asked);
    if (member.spared) continue;
    member.stopped_in = newest_stop();
    member.fence();
  }
  return ++stops_;
}

std::optional<std::vector<StopAnswer>> Guard::stop_outcome(std::uint64_t stop) const {
  const LockGuard lock{mutex_};
  if (stop > stops_ended_) return std::nullopt;
  std::vector<StopAnswer> answers;
  for (const GuardedMember& member : members_) {
    if (member.spared) continue;
    for (const WatchedDevice& device : member.devices)
      answers.push_back({member.apid(), device.name, true, device.stopped, member.stop_killed});
    for (const std::string& device : member.not_asked)
      answers.push_back({member.apid(), device, false, member.stopped, member.stop_killed});
    if (member.devices.empty() && member.not_asked.empty())
      answers.push_back({member.apid(), member.described->subsystem.name, false, member.stopped, member.stop_killed});
  }
  return answers;
}

void Guard::follow_stop(TimePoint now) {
  // How long a stop took is told in real time; who is given how long goes by what was asked.
  bool waiting = false;
  for (GuardedMember& member : members_) {
    if (member.spared || member.settled == stops_) continue;
    const Duration since = asked_ - member.stop_asked;
    if (!member.says_stopped()) member.stopped.reset();
    else if (!member.stopped) member.stopped = now - member.stop_begun;
    if (member.has_stopped()) continue;
    if (since >= member.stop_limit() && !member.stop_killed && member.grip && member.to_blame()) {
      member.stop_killed = true;
      member.grip->kill();
      find_out(GuardFinding::Kind::Killed, member.apid());
    }
    waiting = waiting || since < member.stop_limit() + (member.stop_killed ? killed_limit : Duration{0});
  }
  if (waiting) return;
  stops_ended_ = stops_;
  if (parts_.on_finding) parts_.on_finding();
}

}  // namespace hirosco::supervisor
