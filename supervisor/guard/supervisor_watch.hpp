// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "supervisor/guard/guard_findings.hpp"
#include "supervisor/guard/guard_roster.hpp"
#include "supervisor/guard/stop_number.hpp"

namespace hirosco::supervisor {

/// Whether the supervisor's own loop moves: when it is found to stand still everybody is fenced.
/// Thread: under the guard's mutex, but for beat().
class SupervisorWatch {
 public:
  /// The supervisor's own loop steps every 10 ms.
  static constexpr Duration supervisor_limit = std::chrono::seconds{1};

  struct Parts {
    GuardRoster& guarded;
    StopNumber& number;
    GuardFindings& findings;
  };
  explicit SupervisorWatch(const Parts& parts) : parts_{parts} {}

  /// It has moved.  Realtime: wait-free. Thread: the supervisor's loop.
  void beat() noexcept { beats_.fetch_add(1, std::memory_order_relaxed); }
  /// \param now In watched time.  Realtime: bounded; no heap but for findings.
  void step(TimePoint now);
  [[nodiscard]] bool still() const noexcept { return supervisor_still_; }

 private:
  Parts parts_;
  std::atomic<std::uint64_t> beats_{0};
  std::uint64_t seen_beats_{0};
  std::optional<TimePoint> beat_seen_;
  bool supervisor_still_{false};
};

}  // namespace hirosco::supervisor
