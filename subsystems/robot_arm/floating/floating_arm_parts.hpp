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
#include "subsystems/robot_arm/floating/floating_laws.hpp"
#include "subsystems/robot_arm/floating/floating_motions.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/floating/floating_tip.hpp"
#include "subsystems/robot_arm/floating/floating_tool_lead.hpp"
#include "subsystems/robot_arm/floating/floating_work.hpp"
#include "subsystems/robot_arm/force_sensor.hpp"
#include "subsystems/robot_arm/lead.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/posture.hpp"
#include "subsystems/robot_arm/tool_and_payload.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco {

/// The parts of an arm on a base that floats, and what it tells of what is optional. What telecommands ask of them is CommandedFloatingArm's.
class FloatingArmParts : public Subsystem {
 protected:
  FloatingArmParts() = default;

  /// Whoever asked for a motion hears that it ended, and it goes on no further.
  template <FailureEnumeration Code>
  void end_motion(Code why, std::int64_t number = 0, const char* text = "") noexcept {
    if (motion_) abort(*motion_, why, text, number);
    motion_.reset();
    guidance_.end_motion();
  }

  robot_arm::FloatingParameters parameters_;
  Event<double> retracted_{"RETRACTED"};  ///< how far, rad or m
  /// Joint from 1, what acts on it, the limit, and what is done about it.
  Event<std::uint8_t, double, double, std::uint8_t> contact_met_{"CONTACT"};
  Event<double, double, std::uint8_t> wrist_contact_{"WRIST_CONTACT"};  ///< N, N m, what is done about it
  Event<std::uint32_t> force_sensor_lost_{"FORCE_SENSOR_LOST"};  ///< ms
  /// What was measured, the limit, N or W.
  Event<double, double> force_exceeded_{"TOOL_FORCE_EXCEEDED"}, power_exceeded_{"POWER_LIMIT_EXCEEDED"},
      tool_power_exceeded_{"TOOL_POWER_EXCEEDED"};
  Event<std::uint32_t> lead_lost_{"LEAD_LOST"};  ///< cycles
  Event<> lead_let_go_{"LEAD_LET_GO"};
  /// Joint from 1, what was asked, the limit, and which.
  Event<std::uint8_t, double, double, std::uint8_t> lead_unfit_{"LEAD_UNFIT"};
  Event<double, double, std::uint8_t> tool_lead_unfit_{"TOOL_LEAD_UNFIT"};  ///< likewise of its tool

  // Each refers to some of those before it.
  robot_arm::UrdfArm known_;
  robot_arm::Drives drives_{parameters_.current};
  robot_arm::FloatingCraft craft_{{known_, drives_, parameters_}};
  robot_arm::Obstacles obstacles_{{parameters_.clearance_limit_m, parameters_.clearance_m, parameters_.keep_out}};
  robot_arm::Posture posture_{known_};
  robot_arm::AbortPath abort_path_{{known_, obstacles_}};
  robot_arm::FloatingMotions guidance_{{known_, drives_, craft_, obstacles_, parameters_, abort_path_, posture_}};
  robot_arm::FloatingAhead ahead_{{known_, drives_, craft_, obstacles_}};
  robot_arm::ToolAndPayload carried_{
      {obstacles_, parameters_.tool_place, parameters_.payload, parameters_.tool_radius_m}};
  robot_arm::FloatingTip tip_{{carried_, craft_, guidance_}};
  robot_arm::ForceSensor force_sensor_{{drives_, parameters_.contact}};
  robot_arm::FloatingContact contact_{{known_, drives_, craft_, force_sensor_, parameters_}};
  robot_arm::FloatingWork work_{{known_, drives_, craft_, contact_, parameters_}};
  robot_arm::FloatingLaws laws_;
  robot_arm::Lead lead_{known_};
  robot_arm::FloatingToolLead tool_lead_{parameters_};
  std::optional<Call> motion_;
  bool moving_{false};  ///< what is put out reaches the joints
  bool braked_{false};  ///< by BRAKE or a finding, until the next entry into Operational
};

}  // namespace hirosco
