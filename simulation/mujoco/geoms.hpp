// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <mujoco/mujoco.h>

#include "simulation/mujoco/shapes.hpp"

/// What can touch in a world, as MuJoCo is told of it.
namespace hirosco::simulation {

/// Bits of who meets whom. The hull of a link's mesh is larger than the link, centimetres between two that are bent around each other: it meets
/// what is no link of the same robot. Its pieces meet links of the same robot and what pieces these have.
inline constexpr int of_links = 1, of_meshes = 2, of_others = 4, of_pieces = 8;

/// A shape of this body, which weighs nothing and is a link's. Where two touch that of the higher priority says what friction there is.
/// Realtime: allocates.
mjsGeom& add_geom(const Shape& shape, double friction, int priority, mjsBody& body, const std::string& name = {});

}  // namespace hirosco::simulation
