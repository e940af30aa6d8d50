// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/guidance.hpp"
#include "subsystems/robot_arm/joint_contact.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/on_board_model.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/torque_control.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// How an arm gives way (adr 0117): which law is in force, and what it does about a contact.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Yielding {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    OnBoardModel& model;
    Obstacles& obstacles;
    Guidance& guidance;
    TorqueControl& control;
    const Parameters& parameters;
  };
  using Reaction = JointContact::Reaction;
  using Before = JointContact::Before;
  struct Contact : JointContact::Contact {
    std::uint8_t reaction{0};
  };
  /// What the arm was about when it was met.
  struct Doing {
    bool stood{false};  ///< it rested, and nobody waited for a motion
    bool stopping{false};  ///< STOP is under way
  };
  explicit Yielding(const Parts& parts) noexcept : parts_{parts} {}

  /// Takes the present position as the reference, and is hard: entering Operational moves nothing.
  void engage() noexcept;
  /// Another law from now on, where the arm is.
  void take_law(LawKind kind) noexcept;
  /// Comes to rest; who is led stands where he is.
  void stand() noexcept;
  /// Stands before links meet: whoever leads it there has it float no more, however hard he pushes, until arm().
  void stand_apart() noexcept;

  /// Whoever is met from now on is told, whatever was told before.
  void arm(Before load) noexcept;

  /// Each cycle: what it met, once for each time; nothing mostly.
  [[nodiscard]] std::optional<Contact> meet() noexcept;
  /// To whatever is met now.
  [[nodiscard]] Reaction reaction() const noexcept;
  /// Who backs off and meets somebody else stands; so does who is stopped, and who stood: it is not he who went there.
  void react(const Doing& doing) noexcept;

  // --- functions, at rest -------------------------------------------------------------------------------------------------
  /// Stiffness of each joint, and damping.
  [[nodiscard]] Outcome soften_joints(const FunctionValues& values) noexcept;
  [[nodiscard]] Outcome soften_tool(double stiffness_n_m, double turning_n_m, double damping) noexcept;
  /// FLOAT: carried and damped alone from now on. Who moves on the way there would go on: it has to stand, as measured, too.
  [[nodiscard]] Outcome let_go() noexcept;
  /// Hard again, where it is.
  void harden() noexcept;

 private:
  [[nodiscard]] Outcome soften(LawKind kind, const Impedance& impedance) noexcept;

  Parts parts_;
  JointContact felt_;
  bool stands_apart_{false};
};

}  // namespace hirosco::robot_arm
