// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// What joints are given besides what carries the arm.
struct Driven {
  JointVector torque;  ///< as somebody wants it, or less
  JointVector brake;  ///< against a motion that would leave what the joint may do
};

/// Torques that somebody wants of joints, as far as ranges, velocities, accelerations and efforts permit. Wherever a joint is, it may be
/// so fast as can be braked away before the end of its range, and as 0.9 of its velocity: towards that speed the torque is taken back, and
/// beyond it the joint is braked. What accelerates grows as the joint's acceleration permits: an arm that is free goes no harder, and one
/// that presses against something has all of the torque by and by.
class TorqueDrive {
 public:
  /// Nothing is wanted of so many joints.
  void begin(Eigen::Index joints) noexcept;
  /// N m or N, from now on; they come within some tens of milliseconds.
  void want(const JointVector& torque) noexcept { wanted_ = torque; }

  /// Of this cycle.
  struct Carried {
    JointVector held;  ///< N m or N that carry the arm
    JointVector moved;  ///< kg m2 or kg: what each joint moves
  };
  /// `torque_share`: of each joint's effort, for what carries and what drives together.
  const Driven& step(const Measured& measured, const Carried& carried, Bounds bounds, double torque_share,
                     double cycle_s) noexcept;
  [[nodiscard]] const Driven& driven() const noexcept { return driven_; }

 private:
  JointVector wanted_, smooth_;
  JointVector reached_;  ///< speed that acceleration permits by now
  Driven driven_;
};

}  // namespace hirosco::robot_arm
