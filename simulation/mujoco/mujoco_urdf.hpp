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

/// Of a URDF file: links, inertias, joints, what mimics them, and the shapes that touch. Neighbours, which one joint holds together, and links that are at
/// each other where all joints are at 0 (or as near as their ranges let them) pass through each other; the latter are told. In words why there is none.
/// `mark`: begin of the names by which MuJoCo is told of its files, another one for each robot of a world.  Realtime: allocates.
[[nodiscard]] std::expected<MujocoSpec, std::string> spec_of_urdf(std::string_view urdf, const MeshSource& meshes,
                                                                  std::string_view mark = {});

/// The joints of a URDF file that move by themselves, in its order. In words why there are none.
[[nodiscard]] std::expected<std::vector<DrivenJoint>, std::string> driven_joints(std::string_view urdf);

}  // namespace hirosco::simulation
