// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/control/torque_drive.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/guidance.hpp"
#include "subsystems/robot_arm/limit_watch.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/on_board_model.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/torque_control.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"
#include "subsystems/robot_arm/yielding.hpp"

namespace hirosco::robot_arm {

/// An arm that is driven by torques (adr 0178): for a time, which whoever drives it says anew before it is over; then the law of before holds it
/// where it is.
/// Realtime: bounded, but begin(). Thread: the cycle, and the service loop while there is none.
class TorqueMode {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    const LimitWatch& limits;
    OnBoardModel& model;
    Obstacles& obstacles;
    Guidance& guidance;
    TorqueControl& control;
    Yielding& yielding;
    Parameters& parameters;  ///< DES_TORQUE tells with what it is driven
  };
  explicit TorqueMode(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure().  Realtime: bounded. Thread: the service loop.
  void begin(double cycle_s) noexcept;
  /// A torque for each joint, and for how long: refused, or running; once more while it drives, the time begins anew.
  [[nodiscard]] Outcome drive(const FunctionValues& values) noexcept;
  [[nodiscard]] bool drives() const noexcept { return parts_.control.kind() == LawKind::Torque; }
  /// Each cycle: goes on, or stands when its time is over.
  void advance() noexcept;
  /// Nobody waits for it any more: it stands from the next cycle on.
  void end() noexcept;
  /// Stands now, by the law of before.
  void stand() noexcept;

 private:
  void weigh() noexcept;
  [[nodiscard]] Outcome may_press(const JointVector& torque) noexcept;

  Parts parts_;
  TorqueDrive drive_;
  double cycle_s_{0.001};
  double left_s_{0};
  LawKind before_{LawKind::Position};
  robotics::MassMatrix mass_;  ///< with rotors
  Eigen::LLT<robotics::MassMatrix> factors_;
};

}  // namespace hirosco::robot_arm
