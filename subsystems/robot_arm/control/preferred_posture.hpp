// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// To where joints go that a tool leaves free (docs/adr/0219). With a gain of 0: nowhere else than where they stand.
struct PreferredPosture {
  JointVector joints;
  double gain_per_s{0};  ///< while a tool goes along a line: so fast the way to it gets shorter
  [[nodiscard]] bool counts() const noexcept { return gain_per_s > 0; }
};

}  // namespace hirosco::robot_arm
