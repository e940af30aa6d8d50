// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/bounds.hpp"

#include <cmath>

namespace hirosco::robot_arm {

std::expected<std::vector<JointBounds>, std::string> bounds_of(const robotics::Model& model) {
  std::vector<JointBounds> bounds;
  for (const auto& joint : model.joints()) {
    const auto& limits = joint.limits;
    if (!limits.effort || !(*limits.effort > 0) || !limits.velocity || !(*limits.velocity > 0))
      return std::unexpected{"joint '" + joint.name + "' has no effort or velocity above 0, and the arm keeps both"};
    bounds.push_back({.lowest = limits.lower.value_or(-HUGE_VAL),
                      .highest = limits.upper.value_or(HUGE_VAL),
                      .effort = *limits.effort,
                      .motion = {.velocity = *limits.velocity, .acceleration = 0, .jerk = 0}});
  }
  return bounds;
}

}  // namespace hirosco::robot_arm
