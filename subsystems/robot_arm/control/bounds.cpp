// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/bounds.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// Of what dry friction leaves of its effort a joint that is led gives damping no more: it has weight to carry, too, speeds up and slows down, and all of
/// it is within TORQUE_LIMIT.
constexpr double share_for_damping = 0.5;

/// With which it is driven on against damping: whatever is asked of it beyond, it is stopped, or falls behind.
[[nodiscard]] double driven_velocity(const robotics::Model::Joint& joint) noexcept {
  const double left = *joint.limits.effort - joint.friction;
  return joint.damping > 0 && left > 0 ? share_for_damping * left / joint.damping : HUGE_VAL;
}

}  // namespace

std::expected<std::vector<JointBounds>, std::string> bounds_of(const robotics::Model& model) {
  std::vector<JointBounds> bounds;
  for (const auto& joint : model.joints()) {
    const auto& limits = joint.limits;
    if (!limits.effort || !(*limits.effort > 0) || !limits.velocity || !(*limits.velocity > 0))
      return std::unexpected{"joint '" + joint.name + "' has no effort or velocity above 0, and the arm keeps both"};
    const double velocity = std::min(*limits.velocity, driven_velocity(joint));
    bounds.push_back({.lowest = limits.lower.value_or(-HUGE_VAL),
                      .highest = limits.upper.value_or(HUGE_VAL),
                      .effort = *limits.effort,
                      .motion = {.velocity = velocity, .acceleration = 0, .jerk = 0},
                      .told_velocity = *limits.velocity});
  }
  return bounds;
}

}  // namespace hirosco::robot_arm
