// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robotics/subsystem/moving_subsystem.hpp"
#include "subsystems/robot_arm/abort_path.hpp"
#include "subsystems/robot_arm/at_tip.hpp"
#include "subsystems/robot_arm/contact_watch.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/events.hpp"
#include "subsystems/robot_arm/force_sensor.hpp"
#include "subsystems/robot_arm/guidance.hpp"
#include "subsystems/robot_arm/homing.hpp"
#include "subsystems/robot_arm/lead.hpp"
#include "subsystems/robot_arm/limit_watch.hpp"
#include "subsystems/robot_arm/motion_rules.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/on_board_model.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/posture.hpp"
#include "subsystems/robot_arm/self_check.hpp"
#include "subsystems/robot_arm/tool_and_payload.hpp"
#include "subsystems/robot_arm/torque_control.hpp"
#include "subsystems/robot_arm/torque_mode.hpp"
#include "subsystems/robot_arm/trouble.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"
#include "subsystems/robot_arm/yielding.hpp"

namespace hirosco {

/// The parts of an arm, and what telecommands ask of them. What comes of that from cycle to cycle is RobotArm's.
class CommandedArm : public robotics::MovingSubsystem {
 protected:
  CommandedArm() noexcept
      : MovingSubsystem{{.inhibited = static_cast<pus::FailureCode>(robot_arm::Trouble::actuators_inhibited),
                         .limit_tripped = static_cast<pus::FailureCode>(robot_arm::Trouble::limit_tripped)}} {}

  /// In software_init(): reads the robot, and makes known what its descriptor offers, and nothing else.
  Result<> bind();
  void stand() noexcept override;
  void motion_ended() noexcept override { torque_mode_.end(), guidance_.end_motion(), homing_.end(); }

  robot_arm::Parameters parameters_;
  robot_arm::Events events_;

  // Each refers to some of those before it.
  robot_arm::UrdfArm known_;
  robot_arm::Drives drives_{parameters_.current};
  robot_arm::LimitWatch limits_{{known_, drives_, parameters_}};
  robot_arm::OnBoardModel model_{{known_, drives_, parameters_, limits_.work()}};
  robot_arm::ForceSensor force_sensor_{{drives_, parameters_.contact}};
  robot_arm::Obstacles obstacles_{{parameters_.clearance_limit_m, parameters_.clearance_m, parameters_.keep_out}};
  robot_arm::AbortPath abort_path_{{known_, obstacles_}};
  robot_arm::Posture posture_{known_};
  robot_arm::Guidance guidance_{{known_, drives_, obstacles_, parameters_, abort_path_, posture_}};
  robot_arm::Lead lead_{known_};
  robot_arm::TorqueControl control_{{known_, drives_, limits_, model_, guidance_, parameters_}};
  robot_arm::Homing homing_{{known_, drives_, control_, parameters_}};
  robot_arm::MotionRules rules_{{guidance_, control_, lead_, homing_}};
  robot_arm::Yielding yielding_{{known_, drives_, model_, obstacles_, guidance_, control_, parameters_}};
  robot_arm::ContactWatch contact_watch_{{guidance_, control_, yielding_, force_sensor_}};
  robot_arm::ToolAndPayload carried_{
      {obstacles_, parameters_.tool_place, parameters_.payload, parameters_.tool_radius_m}};
  robot_arm::AtTip at_tip_{{limits_, model_, carried_, guidance_, control_}};
  robot_arm::TorqueMode torque_mode_{
      {known_, drives_, limits_, model_, obstacles_, guidance_, control_, yielding_, parameters_}};
  robot_arm::SelfCheck self_check_{{known_, drives_, guidance_, control_, yielding_, homing_, parameters_}};

 private:
  using Begin = robot_arm::Guidance::Begin;

  void bind_motions();
  void bind_settings();
  void bind_laws();
  void bind_lead();
  void bind_force_sensor();
  void use_arm();
  void bind_homing();

  [[nodiscard]] robot_arm::MotionRules::Now now() const noexcept { return {moving_, motion_ || stop_}; }
  Outcome move(Begin begin, const FunctionValues& values, const Call& call) noexcept;
  Outcome leave(Begin begin, const FunctionValues& values, const Call& call) noexcept;
  Outcome check_abort(const Call& call) noexcept;
  Outcome drive(const FunctionValues& values, const Call& call) noexcept;
  Outcome jog(Begin begin, const FunctionValues& values, const Call& call) noexcept;
};

}  // namespace hirosco
