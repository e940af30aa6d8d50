// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/inhibit_watch.hpp"

#include <utility>

namespace hirosco::supervisor {

void InhibitWatch::step(GuardedMember& member, TimePoint now) {
  for (WatchedDevice& device : member.devices) device.hear(now);
  // All of them, before one is told anything: who is fenced for one is enabled by none.
  for (WatchedDevice& device : member.devices) judge(member, device, now);
}

void InhibitWatch::judge(GuardedMember& member, WatchedDevice& device, TimePoint now) {
  using enum GuardFinding::Kind;
  if (std::exchange(device.falls_back, false)) findings_.find_out(InhibitFellBack, member.apid(), device.place);
  if (!member.released || !member.uses(device.place)) return;
  const Duration limit = member.limit_of(device);
  if (limit > Duration{} && device.unconfirmed(member.released_at, limit, now)) return lose(member, device, now);
  if (limit == Duration{} && member.seen_operational && device.falls_silent(member.released_at, now))
    findings_.find_out(device.why_silent(), member.apid(), device.place);
}

void InhibitWatch::lose(GuardedMember& member, WatchedDevice& device, TimePoint now) {
  using enum GuardFinding::Kind;
  // Where it does not go on, the way is chosen anew when it is let go again.
  if (device.goes_on && device.fall_back(now)) return findings_.find_out(InhibitFellBack, member.apid(), device.place);
  member.fence_by_guard();
  findings_.find_out(InhibitLost, member.apid(), device.place);
}

}  // namespace hirosco::supervisor
