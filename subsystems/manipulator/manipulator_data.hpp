// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "subsystems/manipulator/control/joints.hpp"

/// Structures of an arm's descriptor: same members, same order; lengths are the descriptor's.
namespace hirosco::manipulator {

struct CurrentValues {
  std::int32_t state;
  Joints position_rad;
  Joints velocity_rad_per_s;
  Joints torque_n_m;
  Temperatures temperature_deg_c;
  std::uint16_t device_flags;
};
struct ClutchValues {
  Joints robot_rad;
  Joints handle_rad;
};
struct TrajectoryValues {
  Joints target_rad;
  double duration_s;
  double progress;
};
struct HandleState {
  Joints position_rad;
  Joints velocity_rad_per_s;
  std::uint8_t enable;
};
struct RobotInput {
  Joints motor_position_rad;
  Joints motor_velocity_rad_per_s;
  Joints position_rad;
  Joints velocity_rad_per_s;
  Joints torque_n_m;
  Temperatures temperature_deg_c;
  std::uint8_t tool;  ///< what it holds, 0: nothing
};
struct RobotOutput {
  Joints torque_n_m;
  std::uint8_t tool;  ///< to be held; the device acts on a change
};
struct GainValues {
  double kp_n_m_per_rad;
  double kd_n_m_s_per_rad;
};

}  // namespace hirosco::manipulator
