// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/xml/reader.hpp"

/// What can touch in a world: the collision shapes of a URDF file's links, and obstacles that stand around the robot. No MuJoCo here.
namespace hirosco::simulation {

enum class ShapeKind : std::uint8_t {
  Box,  ///< sizes: its three sides
  Cylinder,  ///< radius, length along its own z
  Sphere,  ///< radius
  Plane,  ///< none: all below its own z = 0 is solid
  Mesh,  ///< factors by which it is scaled; its convex hull touches
};

struct Shape {
  ShapeKind kind{ShapeKind::Box};
  std::array<double, 3> sizes{};  ///< m
  std::array<double, 3> place_m{};
  std::array<double, 3> turned_rad{};  ///< about x, then y, then z of the frame it stands in, as a URDF file's rpy
  std::string mesh{};  ///< file as the URDF file names it
};

struct LinkShape {
  std::string link;
  Shape shape;
};

/// What the <collision> elements of a robot say. A shape that cannot be taken is told with its link and the reason.
struct LinkShapes {
  std::vector<LinkShape> taken;
  std::vector<std::string> left_out;
};
/// The first child element of this name; null: there is none.
[[nodiscard]] const xml::Element* child_of(const xml::Element& element, std::string_view name) noexcept;
/// The strict reader of the arm has seen the file first, but it passes over shapes.  Realtime: allocates.
[[nodiscard]] LinkShapes link_shapes(const xml::Element& robot);

/// Stands where it is, in the axes of the base.
struct Obstacle {
  std::string name;
  Shape shape;
  double friction{0.5};  ///< of sliding, whatever slides on it
};
inline constexpr std::size_t most_obstacles = 16;

/// `words`: SHAPE [SIZES] X,Y,Z [FRICTION [ROLL,PITCH,YAW]], where SHAPE and SIZES are `box A,B,C`, `cylinder RADIUS,LENGTH`, `sphere RADIUS`
/// or `plane`. In words what is wrong.  Realtime: allocates.
[[nodiscard]] std::expected<Obstacle, std::string> read_obstacle(std::string_view name,
                                                                 std::span<const std::string_view> words);

/// Falls, slides, is held: moves by itself. `standing` says where it begins, and its shape is no plane.
struct LooseBody {
  Obstacle standing;
  double mass_kg{1};
};
inline constexpr std::size_t most_bodies = 8;

/// `words`: SHAPE SIZES MASS X,Y,Z [FRICTION [ROLL,PITCH,YAW]], as of an obstacle; MASS in kg. In words what is wrong.  Realtime: allocates.
[[nodiscard]] std::expected<LooseBody, std::string> read_body(std::string_view name,
                                                              std::span<const std::string_view> words);

/// A,B,...: finite numbers with commas between them, as many as there are. Nothing: it is no such list.  Realtime: allocates.
[[nodiscard]] std::expected<std::vector<double>, std::string> listed_numbers(std::string_view text);

/// The octets of a mesh by the file's name, beside the URDF file; in words why there are none.
using MeshSource = std::function<std::expected<std::string, std::string>(const std::string& file)>;
/// Where a mesh that a URDF file names lies beside it: package://A/B is A/B. In words why it is nowhere there, or why MuJoCo cannot read it.
[[nodiscard]] std::expected<std::string, std::string> mesh_file(std::string_view named);

}  // namespace hirosco::simulation
