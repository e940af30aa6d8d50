// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/walls.hpp"
#include "subsystems/robot_arm/floating/floating_model.hpp"

namespace hirosco::robot_arm {

/// Torques of a floating arm that goes wherever it is led (docs/adr/0222): dampers alone, against what the joints move with the base that gives way, and what keeps each within its range and its
/// velocity. There is no gravity that had to be carried. Nothing of it drives, whatever the base does. Within the efforts. `aims` remember where it is.
/// Realtime: wait-free.
[[nodiscard]] JointVector float_torque(const FloatingModel& model, const Measured& measured, const FloatAims& aims,
                                       Bounds bounds, double damping_per_s, double fastest_rad_s) noexcept;

}  // namespace hirosco::robot_arm
