// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robotics/motion/sampled_rates.hpp"
#include "subsystems/robot_arm/control/joints.hpp"

/// Dampers, and what keeps a joint that gives way within its range and its velocity: torques against the motion, or of a potential. Nothing of it drives.
/// Realtime: wait-free. Thread: any.
namespace hirosco::robot_arm {

/// Of what is moved: with so much delay as the cycle has, a stronger one would shake.
[[nodiscard]] double strongest_damper(double moved, double fastest_rad_s) noexcept;
/// Of a spring that moves this, with that ratio.
[[nodiscard]] double damper(double spring, double moved, double ratio, double fastest_rad_s) noexcept;

/// Where a joint may be without a spring: no nearer to an end than before it, or as far as it is to go.
struct Aim {
  double lowest;
  double highest;
};

/// Aims of an arm that floats, which has no setpoint but where it is, also at an end: springs that began behind that would never begin. Let go of nearer to an end than its spring, it is not
/// thrown away from there; where it has come away from an end, its spring begins.
/// Realtime: wait-free, no allocation. Thread: the cycle.
class FloatAims {
 public:
  /// It is let go of wherever it is when it is remembered next.
  void let_go() noexcept { let_go_ = true; }
  /// Each cycle in which it floats, before of().
  void remember(const JointVector& position) noexcept;
  [[nodiscard]] Aim of(Eigen::Index joint) const noexcept { return {above_lowest_[joint], below_highest_[joint]}; }

 private:
  /// Since it was let go: the farthest that each joint has been from either end.
  JointVector above_lowest_, below_highest_;
  bool let_go_{true};
};

/// A spring and a damper of a joint that begin before its range ends, or behind its aim where that is nearer to the end; and a
/// damper before its velocity, or what is wanted of it.
[[nodiscard]] double walls(const Aim& aim, double wanted_speed, const Measured& measured, Eigen::Index joint,
                           double moved, const JointBounds& bounds, double fastest_rad_s) noexcept;

}  // namespace hirosco::robot_arm
