// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "subsystems/robot_gripper/control/fingers.hpp"

/// Structures of a gripper's descriptor: same members, same order; lengths are the descriptor's.
namespace hirosco::robot_gripper {

struct CurrentValues {
  std::int32_t state;
  Joints position;
  Joints velocity;
  Joints torque;
  std::uint16_t device_flags;
};
struct GapValues {
  double width_m;
  double speed_m_s;
  double force_n;
  std::uint8_t held;
  std::uint8_t law;  ///< of LAWS
  double wanted_width_m;
  double wanted_force_n;
  double held_width_m;  ///< of what was held last
};

struct GripperInput {
  Joints position;
  Joints velocity;
  Joints torque;
};
struct GripperOutput {
  Joints torque;
};

}  // namespace hirosco::robot_gripper
