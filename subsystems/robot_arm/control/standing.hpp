// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// Of a joint's velocity: what is faster does not stand. Let go of, it goes on by that over the damping of an arm that floats.
inline constexpr double standing_share = 0.05;

/// A joint, from 0, that moves yet. A setpoint that rests is not enough: springs may swing the arm, or somebody pushes it on.
[[nodiscard]] inline std::optional<std::size_t> still_moves(const JointVector& velocity, Bounds bounds) noexcept {
  for (std::size_t joint = 0; joint < bounds.size(); ++joint)
    // Written so that what is no number moves.
    if (!(std::abs(velocity[static_cast<Eigen::Index>(joint)]) <= standing_share * bounds[joint].motion.velocity))
      return joint;
  return std::nullopt;
}

}  // namespace hirosco::robot_arm
