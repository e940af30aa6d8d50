// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/floating/floating_arm_parts.hpp"

namespace hirosco {

/// What telecommands ask of the parts of an arm on a base that floats. What comes of that from cycle to cycle is FloatingArm's.
class CommandedFloatingArm : public FloatingArmParts {
 protected:
  CommandedFloatingArm() = default;

  /// In software_init(): makes known what its descriptor offers, and nothing else.
  void bind_functions();
  /// Before use_device(): what it tells depends on it.
  void bind_force_sensor();
  /// What is a number for each joint has as many as the URDF file has joints.
  [[nodiscard]] Result<> check_lengths() noexcept;

  void finish_call() noexcept;

 private:
  using Out = robot_arm::FloatingWayOut::By;

  void bind_ways_out();
  void bind_jogs();
  void bind_tip();
  void bind_contact();
  void bind_work();
  void bind_laws();
  void bind_lead();
  [[nodiscard]] bool offers(const char* function) const { return own_descriptor().find_function(function) != nullptr; }

  void hold() noexcept;
  [[nodiscard]] Outcome may_move() const noexcept;
  [[nodiscard]] Outcome may_leave() const noexcept;
  Outcome let_go() noexcept;
  Outcome soften(robot_arm::LawKind kind, const robot_arm::Impedance& impedance) noexcept;
  Outcome leave(Out by, double number, const Call& call) noexcept;
  Outcome check_abort(const Call& call) noexcept;
  template <class Begin>
  Outcome jog(bool goes_on, const Begin& begin, const Call& call) noexcept;
  [[nodiscard]] Outcome started(const Outcome& outcome, const Call& call) noexcept;
};

}  // namespace hirosco
