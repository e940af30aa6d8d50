// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/robot_arm/abort_path.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/floating/floating_ahead.hpp"
#include "subsystems/robot_arm/floating/floating_contact.hpp"
#include "subsystems/robot_arm/floating/floating_craft.hpp"
#include "subsystems/robot_arm/floating/floating_motions.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/floating/floating_tip.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/tool_and_payload.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco {

/// The parts of an arm on a base that floats, and what telecommands ask of them. What comes of that from cycle to cycle is FloatingArm's.
class CommandedFloatingArm : public Subsystem {
 protected:
  CommandedFloatingArm() = default;

  /// In software_init(): makes known what its descriptor offers, and nothing else.
  void bind_functions();
  /// What is a number for each joint has as many as the URDF file has joints.
  [[nodiscard]] Result<> check_lengths() noexcept;

  /// Whoever asked for a motion hears that it ended, and it goes on no further.
  template <FailureEnumeration Code>
  void end_motion(Code why, std::int64_t number = 0, const char* text = "") noexcept {
    if (motion_) abort(*motion_, why, text, number);
    motion_.reset();
    guidance_.end_motion();
  }
  void finish_call() noexcept;

  robot_arm::FloatingParameters parameters_;
  Event<double> retracted_{"RETRACTED"};  ///< how far, rad or m
  /// Joint from 1, what acts on it, the limit, and what is done about it.
  Event<std::uint8_t, double, double, std::uint8_t> contact_met_{"CONTACT"};

  // Each refers to some of those before it.
  robot_arm::UrdfArm known_;
  robot_arm::Drives drives_{parameters_.current};
  robot_arm::FloatingCraft craft_{{known_, drives_, parameters_}};
  robot_arm::Obstacles obstacles_{{parameters_.clearance_limit_m, parameters_.clearance_m, parameters_.keep_out}};
  robot_arm::AbortPath abort_path_{{known_, obstacles_}};
  robot_arm::FloatingMotions guidance_{{known_, drives_, craft_, obstacles_, parameters_, abort_path_}};
  robot_arm::FloatingAhead ahead_{{known_, drives_, craft_, obstacles_}};
  robot_arm::ToolAndPayload carried_{
      {obstacles_, parameters_.tool_place, parameters_.payload, parameters_.tool_radius_m}};
  robot_arm::FloatingTip tip_{{carried_, craft_, guidance_}};
  robot_arm::FloatingContact contact_{{known_, drives_, craft_, parameters_}};
  std::optional<Call> motion_;
  bool moving_{false};  ///< what is put out reaches the joints
  bool braked_{false};  ///< by BRAKE or a finding, until the next entry into Operational

 private:
  using Out = robot_arm::FloatingWayOut::By;

  void bind_ways_out();
  void bind_jogs();
  void bind_tip();
  void bind_contact();
  [[nodiscard]] bool offers(const char* function) const { return own_descriptor().find_function(function) != nullptr; }

  void hold() noexcept;
  [[nodiscard]] Outcome may_move() const noexcept;
  [[nodiscard]] Outcome may_leave() const noexcept;
  Outcome let_go() noexcept;
  Outcome leave(Out by, double number, const Call& call) noexcept;
  Outcome check_abort(const Call& call) noexcept;
  template <class Begin>
  Outcome jog(bool goes_on, const Begin& begin, const Call& call) noexcept;
  [[nodiscard]] Outcome started(const Outcome& outcome, const Call& call) noexcept;
};

}  // namespace hirosco
