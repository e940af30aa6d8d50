// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/stop_of_all.hpp"

namespace hirosco::supervisor {
namespace {

/// From the end of a member to the answer of its devices (hazard SF2).
constexpr Duration killed_limit = std::chrono::milliseconds{400};

}  // namespace

std::uint64_t StopOfAll::begin(GuardFinding::Kind why) {
  const std::uint64_t stop = begin();
  for (GuardedMember& member : parts_.guarded.members()) member.fence_untold = member.fence_untold || !member.spared;
  parts_.findings.find_out(why, 0);
  return stop;
}

std::uint64_t StopOfAll::begin() {
  const TimePoint now = parts_.clock.now();
  const TimePoint asked = parts_.time.asked_at(now);
  // Stops that overlap end together. The time of each member runs from the first that found it moving: from this one for who moves,
  // or did since the stop that is still open had seen it at rest.
  const bool first = !under_way();
  parts_.number.next();
  for (GuardedMember& member : parts_.guarded.members()) {
    if (first || member.released || member.settled == stops_) member.begin_stop(now, asked);
    if (member.spared) continue;
    member.stopped_in = parts_.number.newest();
    member.fence();
  }
  return ++stops_;
}

bool StopOfAll::lets_go(GuardedMember& member) {
  // What is being stopped is let go again once it has stopped; what it did then is no matter of that stop any more.
  const bool stopping = under_way() && !member.spared;
  if (stopping && !member.has_stopped()) return false;
  if (stopping) {
    member.settled = stops_;
    if (!member.stopped) member.stopped = parts_.clock.now() - member.stop_begun;
  }
  return true;
}

std::optional<std::vector<StopAnswer>> StopOfAll::outcome(std::uint64_t stop) const {
  if (stop > stops_ended_) return std::nullopt;
  std::vector<StopAnswer> answers;
  for (const GuardedMember& member : parts_.guarded.members()) {
    if (member.spared) continue;
    for (const WatchedDevice& device : member.devices)
      answers.push_back({member.apid(), device.name, true, device.stopped, member.stop_killed,
                         device.stopped ? device.rests_otherwise() : std::string_view{}});
    for (const std::string& device : member.not_asked)
      answers.push_back({member.apid(), device, false, member.stopped, member.stop_killed});
    if (member.devices.empty() && member.not_asked.empty())
      answers.push_back({member.apid(), member.described->subsystem.name, false, member.stopped, member.stop_killed});
  }
  return answers;
}

void StopOfAll::follow(TimePoint now) {
  // How long a stop took is told in real time; who is given how long goes by what was asked.
  bool waiting = false;
  for (GuardedMember& member : parts_.guarded.members()) {
    if (member.spared || member.settled == stops_) continue;
    const Duration since = parts_.time.asked() - member.stop_asked;
    if (!member.says_stopped()) member.stopped.reset();
    else if (!member.stopped) member.stopped = now - member.stop_begun;
    if (member.has_stopped()) continue;
    if (since >= member.stop_limit() && !member.stop_killed && member.grip && member.to_blame()) {
      member.stop_killed = true;
      member.grip->kill();
      parts_.findings.find_out(GuardFinding::Kind::Killed, member.apid());
    }
    waiting = waiting || since < member.stop_limit() + (member.stop_killed ? killed_limit : Duration{0});
  }
  if (waiting) return;
  stops_ended_ = stops_;
  parts_.findings.wake();
}

}  // namespace hirosco::supervisor
