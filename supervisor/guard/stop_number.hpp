// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "supervisor/guard/guard_roster.hpp"

namespace hirosco::supervisor {

/// Number of the newest stop of everything, as it stands on all permit pages (docs/adr/0156): what was said under another one lets nobody move. It only
/// rises, over guards that follow each other, too.
/// Thread: under the guard's mutex, but for newest().
class StopNumber {
 public:
  static constexpr std::uint32_t no_stop_yet = 1;

  explicit StopNumber(GuardRoster& guarded) : guarded_{guarded} {}

  /// Realtime: wait-free. Thread: any.
  [[nodiscard]] std::uint32_t newest() const noexcept { return newest_stop_.load(std::memory_order_acquire); }
  void put(std::uint32_t number) noexcept;
  void next() noexcept;
  /// Writes it again: damage of its page would have all that it says refused.
  void renew(GuardedMember& member) const noexcept;

 private:
  GuardRoster& guarded_;
  std::atomic<std::uint32_t> newest_stop_{no_stop_yet};
};

}  // namespace hirosco::supervisor
