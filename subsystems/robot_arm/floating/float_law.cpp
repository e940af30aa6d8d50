// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/float_law.hpp"

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/floating/tool_law.hpp"

namespace hirosco::robot_arm {

JointVector float_torque(const FloatingModel& model, const Measured& measured, const JointVector& walls, Bounds bounds,
                         double damping_per_s) noexcept {
  const Eigen::Index joints = measured.velocity.size();
  JointVector torque = joint_torque(model, JointVector::Zero(joints), measured.velocity, bounds, damping_per_s);
  for (Eigen::Index i = 0; i < joints; ++i) {
    const double effort = bounds[static_cast<std::size_t>(i)].effort, value = torque[i] + walls[i];
    torque[i] = std::isfinite(value) ? std::clamp(value, -effort, effort) : 0;
  }
  return torque;
}

}  // namespace hirosco::robot_arm
