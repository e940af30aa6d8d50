// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/manipulator/control/setpoint_governor.hpp"
#include "subsystems/manipulator/control/trajectory.hpp"
#include "subsystems/manipulator/described_joints.hpp"
#include "subsystems/manipulator/servo.hpp"

namespace hirosco::manipulator {

/// Where the joints are to be: what path, programme or hand ask for, and what of it the control law is given (DES_POSITION), which is always
/// within the joints' ranges and, from cycle to cycle, within the bounds of the governor.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Setpoint {
 public:
  struct Parts {
    const DescribedJoints& joints;
    const Drives& drives;
    Servo& servo;  ///< rests where it does
    Parameters& parameters;
  };
  /// `surface`: what the arm could run into, outlives it; nullptr: nothing.
  Setpoint(const Parts& parts, const Surface* surface) noexcept : parts_{parts}, governor_{surface} {}

  [[nodiscard]] Joints desired_rad() const noexcept { return parts_.parameters.desired_position.load(); }

  // --- it stands ----------------------------------------------------------------------------------------------------------
  /// Is where the motors are, in this cycle.
  void rest() noexcept;
  /// Takes the present position as the reference: entering Operational moves nothing.
  void engage() noexcept;
  /// Stays where the setpoint is.
  void hold() noexcept;

  // --- it moves: what is asked for; govern() follows ----------------------------------------------------------------------
  /// A path from where it is; go_on() takes it along.
  void set_out(const Joints& target_rad, double duration_s) noexcept;
  void go_on(double span_s) noexcept;
  /// By a programme, or by hand.
  void ask(const Joints& position_rad) noexcept { asked_ = position_rad; }
  [[nodiscard]] const Trajectory& path() const noexcept { return trajectory_; }
  /// What is asked for reaches the control law within the bounds of the governor only.
  void govern(double span_s) noexcept;

 private:
  void set_desired(const Joints& position_rad) noexcept;

  Parts parts_;
  Trajectory trajectory_;
  SetpointGovernor governor_;
  Joints asked_;  ///< by path, programme or hand; the setpoint follows within its bounds
};

}  // namespace hirosco::manipulator
