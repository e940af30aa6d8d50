// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "robotics/shapes/mesh.hpp"
#include "robotics/shapes/rounded_hull.hpp"

namespace hirosco::robotics {

/// How a mesh is enclosed: finer takes longer, then and in every cycle.
struct Fineness {
  std::size_t most_hulls{12};
  std::size_t most_corners{RoundedHull::most_corners};
  /// Corners are added until no point is farther outside than this.
  double tolerance_m{0.001};
  /// A piece is cut in two only where that takes away this share of the volume of the hull of the whole, or more.
  double least_gain{0.003};
};

/// Hulls that have the whole surface of the mesh in them, together: it is cut across where its hulls lose most volume by it. What is inside of a body without
/// touching its surface is not seen.  Realtime: allocates.
[[nodiscard]] std::vector<RoundedHull> enclosing(const Mesh& mesh, const Fineness& fineness = {});

/// A hull of some of these points, its radius such that none is outside.  Realtime: allocates.
[[nodiscard]] RoundedHull hull_around(std::vector<Vector3> points, const Fineness& fineness = {});

/// Of the convex hull of these points, m3.  Realtime: allocates.
[[nodiscard]] double hull_volume_m3(std::span<const Vector3> points);

}  // namespace hirosco::robotics
