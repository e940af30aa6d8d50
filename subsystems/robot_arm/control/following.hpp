// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "subsystems/robot_arm/control/joints.hpp"
#include "subsystems/robot_arm/control/power_pace.hpp"

namespace hirosco::robot_arm {

/// Goes after whoever leads, however he jumps: ranges, velocities, accelerations and jerks of the joints are kept by what it is, not by what
/// is asked of it. A first setpoint keeps ranges, velocities and accelerations; the second, which is told, has the mean of its velocities over so long
/// that twice an acceleration is no more than the jerk in that time. The power of the joints it keeps as long as what they hold stays as it is: so does a mean of what keeps it. Where that would be more cycles than there is room for it accelerates
/// less.
class Following {
 public:
  static constexpr std::size_t most_cycles = 512;

  /// `bounds` outlive it and have accelerations and jerks above 0.
  Following(Bounds bounds, double cycle_s) noexcept;

  /// From now on it goes no faster than this permits; who is faster already slows down.
  void keep_power(const PowerPace& power) noexcept { power_ = power; }
  /// Stands there from now on.
  void begin(const JointVector& position) noexcept;
  // --- another cycle, of numbers: -----------------------------------------------------------------------------------------
  /// To a place that itself moves with this velocity.
  const Setpoint& go_to(const JointVector& position, const JointVector& velocity) noexcept;
  const Setpoint& go_with(const JointVector& velocity) noexcept;
  const Setpoint& slow_down() noexcept;

  [[nodiscard]] const Setpoint& now() const noexcept { return now_; }
  /// It stands, and would go on standing.
  [[nodiscard]] bool at_rest() const noexcept { return still_cycles_ >= cycles_; }
  /// Of its mean.
  [[nodiscard]] std::size_t cycles() const noexcept { return cycles_; }

 private:
  [[nodiscard]] double approach(double distance, double acceleration) const noexcept;
  void change_velocity(const JointVector& goal) noexcept;
  const Setpoint& step(const JointVector& wanted) noexcept;

  Bounds bounds_;
  double cycle_s_;
  double closing_per_s_;
  std::size_t cycles_{1};
  std::array<double, max_joints> accelerations_{};
  PowerPace power_;
  JointVector place_, velocity_;  ///< of the first setpoint
  std::array<JointVector, most_cycles> velocities_;  ///< that it had, in a ring
  JointVector sum_;  ///< of them
  JointVector since_turn_;  ///< of those since the ring began anew: what rounding adds to a sum does not last
  std::size_t next_{0};
  std::size_t still_cycles_{0};
  Setpoint now_;
};

}  // namespace hirosco::robot_arm
