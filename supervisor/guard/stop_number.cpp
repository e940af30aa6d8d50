// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: fence (docs/safety/modules.csv).
#include "supervisor/guard/stop_number.hpp"

#include <algorithm>

namespace hirosco::supervisor {

void StopNumber::put(std::uint32_t number) noexcept {
  newest_stop_.store(number, std::memory_order_release);
  for (GuardedMember& member : guarded_.members())
    if (member.permit != nullptr) member.permit->newest_stop.store(number, std::memory_order_release);
}

/// Never 0, which is what somebody says who knows of none, nor as if there had been none.
void StopNumber::next() noexcept { put(std::max(newest() + 1, no_stop_yet + 1)); }

void StopNumber::renew(GuardedMember& member) const noexcept {
  if (member.permit != nullptr) member.permit->newest_stop.store(newest(), std::memory_order_relaxed);
}

}  // namespace hirosco::supervisor
