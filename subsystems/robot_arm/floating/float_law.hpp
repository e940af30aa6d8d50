// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/walls.hpp"
#include "subsystems/robot_arm/floating/floating_model.hpp"

/// Realtime: wait-free.
namespace hirosco::robot_arm {

/// What keeps each joint of a floating arm that gives way within its range and its velocity, not yet within efforts. `aim_of`: an Aim of each joint.
template <class AimOf>
[[nodiscard]] JointVector wall_torque(const FloatingModel& model, const Measured& measured, const AimOf& aim_of,
                                      Bounds bounds, double fastest_rad_s) noexcept {
  JointVector torque = JointVector::Zero(measured.velocity.size());
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    // A payload that is said to be there, and is not, is nothing that a damper may count on.
    const double moved = model.inertia()(i, i) / model.heavier();
    torque[i] = walls(aim_of(i), 0, measured, i, moved, bounds[static_cast<std::size_t>(i)], fastest_rad_s);
  }
  return torque;
}

/// Torques of a floating arm that goes wherever it is led (docs/adr/0222): dampers alone, against what the joints move with the base that gives way, and what keeps each within its range and its
/// velocity (`walls`). There is no gravity that had to be carried. Nothing of it drives, whatever the base does. Within the efforts.
[[nodiscard]] JointVector float_torque(const FloatingModel& model, const Measured& measured, const JointVector& walls,
                                       Bounds bounds, double damping_per_s) noexcept;

}  // namespace hirosco::robot_arm
