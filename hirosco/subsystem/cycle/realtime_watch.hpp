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

/// Uses of the heap once a subsystem is commissioned, as a parameter of every subsystem: HEAP_USES
/// (descriptor/model/framework_parameters.hpp).
struct HeapUses {
  std::uint64_t cycle{0};  ///< allocations and frees in cycles of this configuration
  std::uint64_t service{
      0};  ///< in steps of the service loop, and of loops of its own, in Safe-Operational and Operational, since the process began
  bool counted{false};  ///< false: this program does not see them, and the two are 0
};

/// Sums what steps of the service loop, and of loops of services of their own, use of the heap (docs/adr/0103, 0220), in programs that see it.  Thread: the service loop.
class HeapWatch {
 public:
  /// After each step, with what it did. \return true when it is to be told: at once when it is the first, and then once a
  /// second while more is done.  Realtime: wait-free.
  [[nodiscard]] bool account(const AllocationCount& of_step, TimePoint now) noexcept;
  [[nodiscard]] const AllocationCount& sum() const noexcept { return sum_; }

 private:
  AllocationCount sum_;
  AllocationCount told_;
  TimePoint again_{};
};

}  // namespace hirosco
