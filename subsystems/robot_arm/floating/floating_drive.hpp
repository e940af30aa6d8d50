// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/control/torque_drive.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/floating/floating_craft.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/floating/floating_trouble.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Torques that somebody wants of the joints of a craft that floats, for a time (docs/adr/0235): taken back by what joints may do, as of the arm that stands. Nothing has to be carried; what a joint moves is
/// its own of H*, without a payload that may be lost.
/// Realtime: bounded. Thread: the cycle, and the service loop while there is none.
class FloatingDrive {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    const FloatingCraft& craft;
    Obstacles& obstacles;
    FloatingParameters& parameters;  ///< DES_TORQUE tells with what it is driven
  };
  explicit FloatingDrive(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure().
  void begin(double cycle_s) noexcept;
  /// From now on, a torque for each joint and for how long; of who does not go on, from none. Or why not.
  [[nodiscard]] std::optional<FloatingReason> want(const FunctionValues& values, bool goes_on) noexcept;
  /// Each cycle. False: its time is over.
  [[nodiscard]] bool step() noexcept;
  [[nodiscard]] const Driven& driven() const noexcept { return drive_.driven(); }
  /// Nobody waits for it any more.
  void end() noexcept;

 private:
  [[nodiscard]] std::optional<FloatingReason> presses(const JointVector& torque) noexcept;

  Parts parts_;
  TorqueDrive drive_;
  double cycle_s_{0.001}, left_s_{0};
};

}  // namespace hirosco::robot_arm
