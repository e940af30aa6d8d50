// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "subsystems/robot_arm/no_way_out.hpp"

namespace hirosco::robot_arm {

/// Failure codes of floating_arm.xml: why a function was refused or ended without its effect.
enum class FloatingTrouble : std::uint16_t {
  goal_not_reached = 0x8001,
  out_of_range = 0x8002,  ///< a joint would leave its range, or come to its end
  limit_tripped = 0x8003,
  too_fast = 0x8004,  ///< joints or tool would be faster than they may
  another_law = 0x8005,  ///< not in this configuration
  actuators_inhibited = 0x8006,
  base_is_held = 0x8007,  ///< somebody's actuators act on the base
  ill_conditioned = 0x8008,  ///< it cannot move the tool and leave the base unturned; thousandths
  too_near = 0x8009,  ///< to itself, to the base, or to a volume that it keeps out of; mm
  no_goal = 0x800A,  ///< no way out is stored, or it came by none
  too_slow = 0x800B,  ///< longer than it may take, to go there or to judge it
  contact = 0x800C,
  led = 0x800D,  ///< it gives way to whoever leads it: HOLD first
  load_above_limit = 0x800E,  ///< there is more already than the limit would be
  too_stiff = 0x800F,  ///< what it moves would swing faster on these springs than its law may; rad/s
  soft = 0x8010,  ///< springs hold it that this is not for: POSITION_CONTROL first
  not_led = 0x8011,  ///< nobody leads, or to what is no way for it
};

/// In words that live as long as the program, or as the shapes of whose names they are.
struct FloatingReason {
  FloatingTrouble trouble{};
  const char* text{""};
  std::int64_t number{0};
};

[[nodiscard]] inline FloatingReason reason_of(const NoWayOut& none) noexcept {
  using Why = NoWayOut::Why;
  const FloatingTrouble trouble = none.why == Why::OutOfRange ? FloatingTrouble::out_of_range
                                  : none.why == Why::TooNear  ? FloatingTrouble::too_near
                                  : none.why == Why::TooSlow  ? FloatingTrouble::too_slow
                                                              : FloatingTrouble::no_goal;
  return {trouble, none.text, none.number};
}

}  // namespace hirosco::robot_arm
