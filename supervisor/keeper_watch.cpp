// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper_watch.hpp"

#include <utility>

namespace hirosco::supervisor {

KeeperWatch::Finding KeeperWatch::look(TimePoint now) noexcept {
  Finding found;
  if (here()) {
    const bool still = progress_.stands_still(page_.keeper.load(std::memory_order_relaxed), now);
    const bool before = std::exchange(still_, still);
    found.still = still && !before;
  }
  if (keeper_ != Keeper::Gone) return found;
  if (!std::exchange(lost_told_, true)) {
    found.lost = true;
    // It counts before it hands on, and may have died in between. One that is carried out a second time harms nobody.
    found.stop = page_.stops_asked.load() != page_.stops_taken.load();
    found.end = page_.end_asked.load();
  }
  const TimePoint ends_at{Duration{page_.ends_at.load()}};
  if (found.end == 0 && ends_at != TimePoint{} && now >= ends_at) found.end = KeeperPage::end_of_time;
  if (found.end != 0 && std::exchange(end_told_, true)) found.end = 0;
  return found;
}

}  // namespace hirosco::supervisor
