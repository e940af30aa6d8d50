// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "subsystems/manipulator/control_law.hpp"

/// Structures of manipulator.xml: same members, same order.
namespace hirosco::manipulator {

struct CurrentValues {
  std::int32_t state;
  Joints position_rad;
  Joints velocity_rad_per_s;
  Joints torque_n_m;
  std::array<float, 2> temperature_deg_c;
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
struct JoystickState {
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
  std::array<float, 2> temperature_deg_c;
  std::uint8_t spring;  ///< hooked, 0: none
};
struct RobotOutput {
  Joints torque_n_m;
  std::uint8_t spring;  ///< to be hooked; the device acts on a change
};
struct ScriptValues {
  double speed_m_per_s;
  double over_press_m;
  double bump_height_m;
};
struct GainValues {
  double kp_n_m_per_rad;
  double kd_n_m_s_per_rad;
};

}  // namespace hirosco::manipulator
