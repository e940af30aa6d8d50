// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "subsystems/robot_arm/no_way_out.hpp"

namespace hirosco::robot_arm {

/// Failure codes of robot_arm.xml: why a function was refused or ended without its effect.
enum class Trouble : std::uint16_t {
  goal_not_reached = 0x8001,
  out_of_range = 0x8002,  ///< a joint would leave its range
  limit_tripped = 0x8003,
  contact = 0x8004,
  load_above_limit = 0x8005,
  actuators_inhibited = 0x8006,
  too_slow = 0x8007,  ///< longer than a telecommand is waited for
  line_lost = 0x8008,  ///< the joints cannot follow the line
  no_goal = 0x8009,  ///< it is no place, or where it stands already
  too_near = 0x800A,  ///< to itself, or to a volume that it keeps out of
  too_stiff = 0x800B,  ///< a spring that would swing faster than the law may
  led = 0x800C,  ///< it gives way to whoever leads it: HOLD first
  soft = 0x800D,  ///< springs hold it, and would move: POSITION_CONTROL first
  out_of_reach = 0x800E,  ///< no posture has the tool there
  singular = 0x800F,  ///< a small way of the tool would be a long one of joints there
  not_led = 0x8020,  ///< nobody leads, or not to where it may go
  not_referenced = 0x8030,  ///< a joint does not know its zero
  mark_not_found = 0x8031,  ///< a joint has gone all of its distance
  homing_pressed = 0x8032,  ///< a joint has met something, or what it moves is harder to move than was said
  homing_unfit = 0x8033,  ///< what is declared homes nobody
  other_configuration = 0x8034,  ///< one that homes is for HOME alone, and HOME is for such a one
};

/// In words that live as long as the program, or as the shapes of whose names they are.
struct Reason {
  Trouble trouble{};
  const char* text{""};
  std::int64_t number{0};
};

/// A telecommand is waited for a little longer.
inline constexpr double longest_motion_s = 60;

}  // namespace hirosco::robot_arm
