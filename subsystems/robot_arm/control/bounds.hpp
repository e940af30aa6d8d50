// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <vector>

#include "robotics/dynamics/model.hpp"
#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// Limits of the URDF file, joint by joint; acceleration and jerk, which it does not have, are 0. No joint is led faster than half of what dry
/// friction leaves of its effort drives it against its damping, whatever the file says (docs/adr/0211). In words, with its name, which joint lacks the
/// effort or velocity that each must have.  Realtime: allocates.
[[nodiscard]] std::expected<std::vector<JointBounds>, std::string> bounds_of(const robotics::Model& model);

}  // namespace hirosco::robot_arm
