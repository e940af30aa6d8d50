// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "robotics/dynamics/spatial.hpp"

/// Surfaces of triangles, from files.
namespace hirosco::robotics {

struct Mesh {
  using Triangle = std::array<std::uint32_t, 3>;
  std::vector<Vector3> points;
  std::vector<Triangle> triangles;  ///< of points that there are
};

/// Limits on what comes from outside; more is refused.
inline constexpr std::size_t most_mesh_points = 1'000'000;
/// No robot is larger, m.
inline constexpr double largest_mesh_m = 1e4;

/// What is wrong with a mesh, and where; no line: it is no text, or it is about the whole.
struct MeshProblem {
  descriptor::Location at;
  std::string text;
};

enum class MeshKind : std::uint8_t { Stl, Obj, Collada };
/// By the ending of its name. Nothing: it is none of these.
[[nodiscard]] std::expected<MeshKind, std::string> mesh_kind(std::string_view file);

/// STL, binary or text; OBJ; COLLADA 1.4 and 1.5, of which units, nodes and their places count, but not which axis is up: URDF says so. Colours,
/// normals and lines are passed over; what would be a surface and is not read is refused. A mesh has at least one triangle.  Realtime: allocates.
[[nodiscard]] std::expected<Mesh, MeshProblem> read_mesh(MeshKind kind, std::string_view octets);

/// Whether an STL file is binary: its length says so, as one may begin as a text does.
[[nodiscard]] bool is_binary_stl(std::string_view octets) noexcept;
/// A mesh as the file that every reader of meshes takes: a binary STL. Its points are rounded to FLOAT, less than 0.1 um at 1 m.  Realtime: allocates.
[[nodiscard]] std::string as_binary_stl(const Mesh& mesh);

}  // namespace hirosco::robotics
