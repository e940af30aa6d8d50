// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "robotics/shapes/clearance.hpp"
#include "subsystems/robot_arm/control/joints.hpp"

/// Structures of an arm's descriptor: same members, same order; lengths are the descriptor's.
namespace hirosco::robot_arm {

struct CurrentValues {
  std::int32_t state;
  Joints position;
  Joints velocity;
  Joints torque;
  std::uint16_t device_flags;
};
struct ToolValues {
  std::array<double, 3> position_m;
  std::array<double, 4> orientation_wxyz;
};
struct MotionValues {
  std::uint8_t kind;  ///< of MOTIONS
  double duration_s;
  double progress;
};
struct PayloadValues {
  double mass_kg;
  std::array<double, 3> place_m;
};
struct ContactValues {
  std::uint8_t reaction;  ///< of REACTIONS
  double limit;  ///< of a joint's effort
};
struct LawValues {
  std::uint8_t kind;  ///< of LAWS
  double stiffness_n_m;
  double turning_n_m;
  double damping;
};
/// Of each volume that is kept out of: two points and a radius.
inline constexpr std::size_t volume_numbers = 7;
using KeepOut = std::array<double, robotics::Clearance::most_volumes * volume_numbers>;

struct ArmInput {
  Joints position;
  Joints velocity;
  Joints torque;
};
struct ArmOutput {
  Joints torque;
};

}  // namespace hirosco::robot_arm
