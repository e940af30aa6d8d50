// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/subsystem/author/states.hpp"
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

/// The first piece of an author's code that did within a cycle what real time forbids, for who tests it (testing/rig.hpp, docs/adr/0230).
struct AuthorUses {
  const char* node{nullptr};  ///< "operational()"; null: the handler of a function
  std::uint16_t function{0};  ///< then: its index in the descriptor
  RealtimeUses uses;  ///< all 0: nothing was done
};

/// Lies around one call of an author's code within a cycle.  Realtime: wait-free. Thread: cycle.
class AuthorCall {
 public:
  /// `node`, `function`: as in AuthorUses. \param first outlives this, and is kept once it has something.
  AuthorCall(AuthorUses& first, const char* node, std::uint16_t function = 0) noexcept
      : first_{first}, node_{node}, function_{function} {}
  /// Of the node of a state that has a cyclic one.
  AuthorCall(AuthorUses& first, State state) noexcept;
  ~AuthorCall() {
    const RealtimeUses uses = scope_.uses();
    if (uses != RealtimeUses{} && first_.uses == RealtimeUses{}) first_ = {node_, function_, uses};
  }
  AuthorCall(const AuthorCall&) = delete;
  AuthorCall& operator=(const AuthorCall&) = delete;

 private:
  AuthorUses& first_;
  const char* node_;
  std::uint16_t function_;
  RealtimeScope scope_;
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
