// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "subsystems/robot_arm/abort_path.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/parameters.hpp"

namespace hirosco::robot_arm {

/// What is a number for each joint, of parameters, device and functions, has as many as the URDF file has joints.  Mismatch: the first that has not.
/// Realtime: bounded. Thread: the service loop.
[[nodiscard]] Result<> check_lengths(std::size_t joints, const descriptor::SubsystemDescriptor& subsystem,
                                     const Parameters& parameters, Drives& drives,
                                     const AbortPath& abort_path) noexcept;

}  // namespace hirosco::robot_arm
