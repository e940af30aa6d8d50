// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "supervisor/guard/guard_findings.hpp"
#include "supervisor/guard/guard_roster.hpp"
#include "supervisor/guard/guard_time.hpp"

namespace hirosco::supervisor {

/// Who stands still or takes the processor from others, whom the guard blames for it, and what becomes of that one: fenced, ended where it
/// does not come back.
/// Thread: under the guard's mutex.
class LoopWatch {
 public:
  /// What a member may take to come back after it was found to hang.
  static constexpr Duration grace = std::chrono::seconds{1};
  /// A service loop may be busy in the author's code for this long; in a transient state as long as that may last.
  static constexpr Duration service_limit = std::chrono::seconds{3};
  static constexpr Duration transient_service_limit = std::chrono::seconds{12};

  struct Parts {
    GuardRoster& guarded;
    const GuardTime& time;
    GuardFindings& findings;
  };
  explicit LoopWatch(const Parts& parts) : parts_{parts} {}

  /// Looks at all cycles and service loops, when it is due again.
  /// \param now In watched time, as below.  Realtime: bounded; no heap but for findings.
  void step(TimePoint now);
  /// One that was found to hang: it is back, or its grace is over and it is ended, or neither yet. Only for who is doomed.
  /// Realtime: bounded; no heap but for findings.
  void judge_doomed(GuardedMember& member, TimePoint now);

 private:
  void observe(TimePoint now);
  void observe_cycle(GuardedMember& member, TimePoint now);
  void observe_service(GuardedMember& member, TimePoint now);
  [[nodiscard]] GuardedMember& spinner(GuardedMember& standing);
  void look_who_runs(GuardedMember& standing, TimePoint now) noexcept;
  [[nodiscard]] bool was_starved(GuardedMember& standing, TimePoint now);
  void doom(GuardedMember& member, GuardFinding::Kind why, TimePoint now);

  Parts parts_;
  TimePoint next_observation_{};
};

}  // namespace hirosco::supervisor
