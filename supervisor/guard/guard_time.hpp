// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "supervisor/guard/guard_roster.hpp"

namespace hirosco::supervisor {

/// The two times that count against somebody: a computer, or a guard, that did not run for a while is nobody's fault.
/// Thread: under the guard's mutex.
class GuardTime {
 public:
  /// What may pass between two steps and count; see `watched_at`.
  static constexpr Duration most_unwatched = 4 * guard_period;

  explicit GuardTime(const GuardRoster& guarded) : guarded_{guarded} {}

  /// To be called first in each step, before anybody looks at a cycle.
  void step(TimePoint now) noexcept;
  /// Those of the last step.
  [[nodiscard]] TimePoint watched() const noexcept { return watched_; }
  [[nodiscard]] TimePoint asked() const noexcept { return asked_; }

  /// The time by which somebody is found to stand still: what the guard has watched. While nobody ran (the host was stopped) nobody can be blamed for
  /// standing still, so of a longer time between two steps little counts, unless some cycle went on meanwhile.
  [[nodiscard]] TimePoint watched_at(TimePoint now) const noexcept;
  /// The time by which somebody is ended: that in which the guard asked and could hear. Of a longer time between two of its own steps little
  /// counts, whoever went on: what was done meanwhile, nobody could tell it.
  [[nodiscard]] TimePoint asked_at(TimePoint now) const noexcept;

 private:
  [[nodiscard]] bool somebody_went_on(Duration passed) const noexcept;

  const GuardRoster& guarded_;
  std::optional<TimePoint> stepped_;  ///< last, and what had been watched and asked by then
  TimePoint watched_{}, asked_{};
};

}  // namespace hirosco::supervisor
