// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// What acts on the joints from outside, without measuring an acceleration: the generalised momentum changes by what the model knows
/// (drives, gravity, velocities) and by what it does not know, which is told here behind a filter of first order. What is wrong in
/// the model is told, too.
class MomentumObserver {
 public:
  /// `gain_per_s`: 1 / time constant of the filter.
  MomentumObserver(int joints, double cycle_s, double gain_per_s) noexcept;
  void reset() noexcept;
  /// `dynamics` was updated with what is measured, gravity included; `payload_torque`: what the payload takes without accelerating.
  void update(const Measured& measured, robotics::Dynamics& dynamics,
              const robotics::Coordinates& payload_torque) noexcept;
  /// Likewise by the inertia that the joints feel, and what they take without accelerating, besides a payload: of an arm whose base gives way.
  void update(const Measured& measured, const robotics::MassMatrix& mass, const robotics::Coordinates& bias,
              const robotics::Coordinates& payload_torque) noexcept;
  /// N m or N, in the direction in which it would accelerate the joints.
  [[nodiscard]] const JointVector& external() const noexcept { return external_; }

 private:
  double cycle_s_;
  double gain_per_s_;
  bool started_{false};
  robotics::MassMatrix mass_before_;
  JointVector begun_;  ///< momentum at reset()
  JointVector known_;  ///< what came to it since, the estimate included
  JointVector external_;
};

}  // namespace hirosco::robot_arm
