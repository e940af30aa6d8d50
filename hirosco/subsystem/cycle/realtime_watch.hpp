// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/utilities/allocation_guard.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// Sums what an author's cycles do that real time forbids (docs/adr/0092), in programs that see it.  Thread: the cycle's,
/// begin() while it rests.
class RealtimeWatch {
 public:
  /// `sampling`: period of the cycles that follow, above 0.
  void begin(Duration sampling) noexcept;
  /// After each cycle, with what it did. \return true when it is to be told: at once when it is the first, and then once a
  /// second while more is done.  Realtime: wait-free.
  [[nodiscard]] bool account(const RealtimeUses& of_cycle) noexcept;
  /// Since begin().
  [[nodiscard]] const RealtimeUses& sum() const noexcept { return sum_; }

 private:
  std::uint64_t pause_cycles_{1};
  std::uint64_t rest_cycles_{0};  ///< before it may be told again
  RealtimeUses sum_;
  RealtimeUses told_;
};

}  // namespace hirosco
