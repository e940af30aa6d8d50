// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/floating/tool_law.hpp"

namespace hirosco::robot_arm {

/// Where the joints of a craft that floats are to be, where no law of the tool has them.
/// Realtime: wait-free. Thread: the cycle, and the service loop while there is none.
class KeptJoints {
 public:
  explicit KeptJoints(const Drives& drives) noexcept : drives_{drives} {}

  /// Where they are, they are to be.
  void keep() noexcept { keep(drives_.measured().position); }
  void keep(const JointVector& where) noexcept { from_ = goal_ = where; }
  void begin_course(const JointVector& from, const JointVector& goal) noexcept { from_ = from, goal_ = goal; }
  [[nodiscard]] const JointVector& goal() const noexcept { return goal_; }
  /// They are measured there.
  [[nodiscard]] bool there() const noexcept {
    return (goal_ - drives_.measured().position).cwiseAbs().maxCoeff() <= tolerance_rad;
  }

  /// On their course: for springs.
  [[nodiscard]] Setpoint setpoint(const Course& at) const noexcept {
    const JointVector way = goal_ - from_;
    return {from_ + at.share * way, at.per_s * way, JointVector::Zero(way.size())};
  }
  /// rad/s or m/s of each: on their course.
  [[nodiscard]] JointVector rates(const Course& at) const noexcept {
    const JointVector way = goal_ - from_;
    return at.per_s * way + error_per_s * (from_ + at.share * way - drives_.measured().position);
  }
  /// After whoever finds setpoints.
  [[nodiscard]] JointVector rates(const Setpoint& wanted) const noexcept {
    return wanted.velocity + error_per_s * (wanted.position - drives_.measured().position);
  }

 private:
  static constexpr double error_per_s = 5, tolerance_rad = 1e-3;

  const Drives& drives_;
  JointVector from_, goal_;
};

}  // namespace hirosco::robot_arm
