// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace hirosco::manipulator {

/// Author's failure codes: why a function was refused or ended without its effect. Each arm's descriptor names them.
enum class Trouble : std::uint16_t {
  goal_not_reached = 0x8001,
  too_fast = 0x8002,
  torque_tripped = 0x8003,
  too_hot = 0x8004,
  load_above_limit = 0x8005,
  actuators_inhibited = 0x8006,
  limits_not_ordered = 0x8007,
};

}  // namespace hirosco::manipulator
