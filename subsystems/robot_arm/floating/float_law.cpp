// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/float_law.hpp"

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/floating/tool_law.hpp"

namespace hirosco::robot_arm {

JointVector float_torque(const FloatingModel& model, const Measured& measured, const FloatAims& aims, Bounds bounds,
                         double damping_per_s, double fastest_rad_s) noexcept {
  const Eigen::Index joints = measured.velocity.size();
  JointVector torque = joint_torque(model, JointVector::Zero(joints), measured.velocity, bounds, damping_per_s);
  for (Eigen::Index i = 0; i < joints; ++i) {
    const JointBounds& its = bounds[static_cast<std::size_t>(i)];
    // A payload that is said to be there, and is not, is nothing that a damper may count on.
    const double moved = model.inertia()(i, i) / model.heavier();
    const double value = torque[i] + walls(aims.of(i), 0, measured, i, moved, its, fastest_rad_s);
    torque[i] = std::isfinite(value) ? std::clamp(value, -its.effort, its.effort) : 0;
  }
  return torque;
}

}  // namespace hirosco::robot_arm
