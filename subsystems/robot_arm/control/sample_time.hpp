// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hirosco/utilities/time.hpp"

namespace hirosco::robot_arm {

/// How far apart two samples of a device are, by the cycle's own clock: a device answers each command with what it measures then (docs/guide/your_device.md, duty 1), so what is
/// new in a cycle is of the cycle before. No frame says when it was measured (docs/adr/0229).
/// Realtime: wait-free. Thread: the cycle.
class SampleTime {
 public:
  /// What lies between the newest sample and the one that was new before.
  struct Between {
    double s{0};  ///< 0: none is new in this cycle
    /// Cycles were missed between the command that it answers and this cycle: whether that one was late or this one, its device alone knows.
    bool unsure{false};
  };
  /// In each cycle, with when it was due; `begins`: the first one of a configuration; `fresh`: a sample is new.
  void update(TimePoint planned, Duration period, bool begins, bool fresh) noexcept;
  [[nodiscard]] const Between& between() const noexcept { return between_; }
  /// Periods from the last cycle to this one, 1 where none was missed.
  [[nodiscard]] std::uint32_t periods() const noexcept { return periods_; }
  /// Cycles that were missed lately: in the last half second, and in no more than the last second.
  [[nodiscard]] std::uint32_t missed_lately() const noexcept { return missed_[0] + missed_[1]; }

 private:
  void count_missed(TimePoint planned) noexcept;

  TimePoint last_{};  ///< the cycle before was due then
  TimePoint sampled_{};  ///< what was new last is of then
  TimePoint counts_from_{};
  bool heard_{false};
  std::uint32_t periods_{1};
  std::array<std::uint32_t, 2> missed_{};  ///< in this half second, and in the one before
  Between between_;
};

}  // namespace hirosco::robot_arm
