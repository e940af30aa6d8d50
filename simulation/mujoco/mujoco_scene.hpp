// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/mujoco/mujoco_spec.hpp"
#include "simulation/mujoco/shapes.hpp"

namespace hirosco::simulation {

/// Of an MJCF file, which says what stands, lies and hangs in the world. The robot is its joints of these names, each with what its
/// drive in the scene can do, or else with its `effort` here; tip is the body that the last of them moves. In words why there is none.
/// `mark`: as of spec_of_urdf().  Realtime: allocates.
[[nodiscard]] std::expected<MujocoSpec, std::string> spec_of_scene(std::string_view mjcf,
                                                                   std::vector<DrivenJoint> joints,
                                                                   const MeshSource& files, std::string_view mark = {});

}  // namespace hirosco::simulation
