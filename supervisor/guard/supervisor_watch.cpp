// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/supervisor_watch.hpp"

namespace hirosco::supervisor {

void SupervisorWatch::step(TimePoint now) {
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
  parts_.number.next();
  for (GuardedMember& member : parts_.guarded.members()) {
    member.stopped_in = parts_.number.newest();
    member.fence_by_guard();
  }
  parts_.findings.find_out(GuardFinding::Kind::SupervisorStill, 0);
}

}  // namespace hirosco::supervisor
