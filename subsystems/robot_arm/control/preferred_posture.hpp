// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// In which a tool moves: an arm of more joints has some to spare, one of fewer does not have every pose.
inline constexpr Eigen::Index tool_directions = 6;

/// To where joints go that a tool leaves free (docs/adr/0219). With a gain of 0: nowhere else than where they stand.
struct PreferredPosture {
  JointVector joints;
  double gain_per_s{0};  ///< while a tool goes along a line: so fast the way to it gets shorter
  [[nodiscard]] bool counts() const noexcept { return gain_per_s > 0; }
  /// It says where to begin to look; and of an arm that has joints to spare, to where they go besides.
  [[nodiscard]] bool draws() const noexcept { return counts() && joints.size() > tool_directions; }
};

}  // namespace hirosco::robot_arm
