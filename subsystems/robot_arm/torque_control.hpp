// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "subsystems/robot_arm/control/laws.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/guidance.hpp"
#include "subsystems/robot_arm/limit_watch.hpp"
#include "subsystems/robot_arm/on_board_model.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Which torques keep the arm at its setpoint, by the law in force.
/// Realtime: bounded, but begin(). Thread: the cycle, and the service loop while there is none.
class TorqueControl {
 public:
  struct Parts {
    const UrdfArm& known;
    Drives& drives;
    const LimitWatch& limits;
    OnBoardModel& model;
    const Guidance& guidance;
    Parameters&
        parameters;  ///< DES_POSITION, DES_VELOCITY, LAW, JOINT_STIFFNESS and BANDWIDTH_IN_FORCE tell what it does
  };
  explicit TorqueControl(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure(). OutOfRange: the cycle is too long for any law, us at most.  Realtime: allocates. Thread: the service loop.
  [[nodiscard]] Result<> begin(double cycle_s);
  [[nodiscard]] bool begun() const noexcept { return laws_.has_value(); }
  /// What hangs at the tool is known from now on and takes so much more, N m or N of each joint.
  void take_load(const JointVector& torque) noexcept { laws_->take_load(torque, settings()); }

  /// A cycle of the law: what it finds is put out and told.
  void control() noexcept;

  /// What is in force of BANDWIDTH: no more than the cycle leaves (docs/adr/0193).
  [[nodiscard]] double bandwidth_rad_s() const noexcept;

  [[nodiscard]] Laws& laws() noexcept { return *laws_; }
  [[nodiscard]] LawKind kind() const noexcept { return laws_->kind(); }
  /// It goes wherever it is led.
  [[nodiscard]] bool floats() const noexcept { return kind() == LawKind::Float; }
  /// It is to be wherever it is.
  [[nodiscard]] bool led() const noexcept { return floats() || kind() == LawKind::Torque; }
  /// Where it is may be far from its setpoint, and that is meant.
  [[nodiscard]] bool gives_way() const noexcept { return laws_->gives_way(); }

 private:
  [[nodiscard]] Laws::Settings settings() noexcept;

  Parts parts_;
  std::optional<Laws> laws_;
  double fastest_rad_s_{0};
  Joints rotor_;  ///< of this cycle
};

}  // namespace hirosco::robot_arm
