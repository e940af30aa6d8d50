// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hirosco::robot_gripper {

/// Failure codes of robot_gripper.xml: why a function was refused or ended without its effect.
enum class Trouble : std::uint16_t {
  width_not_reached = 0x8001,
  out_of_range = 0x8002,
  limit_tripped = 0x8003,
  obstructed = 0x8004,  ///< something is in the way
  nothing_met = 0x8005,
  actuators_inhibited = 0x8006,
  too_slow = 0x8007,  ///< longer than a telecommand is waited for
  force_not_reached = 0x8008,
  no_goal = 0x8009,  ///< it is there already
  is_held = 0x800A,  ///< something is held: GRIP with another force, or open
  object_lost = 0x800B,
};

}  // namespace hirosco::robot_gripper
