// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/guard_time.hpp"

#include <algorithm>

namespace hirosco::supervisor {

void GuardTime::step(TimePoint now) noexcept {
  asked_ = asked_at(now);
  watched_ = watched_at(now);
  stepped_ = now;
}

TimePoint GuardTime::watched_at(TimePoint now) const noexcept {
  if (!stepped_) return now;
  const Duration passed = now - *stepped_;
  if (passed <= most_unwatched || somebody_went_on(passed)) return watched_ + passed;
  return watched_ + most_unwatched;
}

TimePoint GuardTime::asked_at(TimePoint now) const noexcept {
  return stepped_ ? asked_ + std::min(now - *stepped_, most_unwatched) : now;
}

/// Half of the cycles that were due count: while the guard alone does not run, a computer may be busy.
bool GuardTime::somebody_went_on(Duration passed) const noexcept {
  return std::ranges::any_of(guarded_.members(), [&](const GuardedMember& member) {
    const Duration sampling = member.sampling();
    if (sampling <= Duration{0} || member.vital->cycling.load(std::memory_order_acquire) == 0) return false;
    const auto went = member.vital->cycles.load(std::memory_order_acquire) - member.cycles;
    return went >= static_cast<std::uint64_t>(passed / sampling / 2 + 1);
  });
}

}  // namespace hirosco::supervisor
