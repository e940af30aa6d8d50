// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "robotics/dynamics/model.hpp"

/// Robots from URDF files: what moves and what has mass. Shapes are passed over.
namespace hirosco::robotics::urdf {

using descriptor::Diagnostic;
using descriptor::Location;

struct Link {
  std::string name;
  Location at;
  std::optional<Inertia> inertia;    ///< in the link's frame; nothing: massless
  bool has_shape{false};
};

enum class JointType : std::uint8_t { Revolute, Continuous, Prismatic, Fixed };

struct Joint {
  std::string name;
  Location at;
  JointType type{JointType::Fixed};
  std::size_t parent{0};             ///< link
  std::size_t child{0};              ///< link; its frame is the joint's
  Pose origin;                       ///< of the child at q = 0 in the parent
  Vector3 axis{Vector3::UnitX()};    ///< of length 1
  JointLimits limits;
  double damping{0};
  double friction{0};
  std::optional<Mimic> mimic;  ///< of a joint in `Robot::joints` that moves by itself, also where the file has a chain
};

/// One tree: every link but the root is the child of one joint.
struct Robot {
  std::string name;
  std::vector<Link> links;  ///< in file order
  std::vector<Joint> joints;  ///< in file order
  std::size_t root{0};  ///< link
};

/// Reads and checks a URDF file: plain URDF 1.0 with revolute, continuous, prismatic and fixed joints. All problems are told at once,
/// each with its place, what is wrong and what to do (docs/urdf-errors.md); extensions that are passed over are named by warnings.
/// `file` is used in the diagnostics.  Realtime: allocates.
[[nodiscard]] descriptor::Reading<Robot> read(const std::filesystem::path& file, std::string_view text);
[[nodiscard]] descriptor::Reading<Robot> read(const std::filesystem::path& file, const descriptor::FileSource& source);

/// Joints with these names stand still at 0 from now on, and what mimics them with them: what they carry is part of what carries them. Something: the
/// first name that is no joint that moves by itself; nothing was done.  Realtime: allocates.
[[nodiscard]] std::optional<std::string> fix(Robot& robot, std::span<const std::string> names);

/// Which joints fix() makes stand with these names, those that mimic them among them, in file order; asked before it does.  Realtime: allocates.
[[nodiscard]] std::vector<std::size_t> led_by(const Robot& robot, std::span<const std::string> names);

/// Something hangs on a joint.
struct Carried {
  std::size_t by{0};  ///< joint
  std::string what;  ///< "link 'tool'", "joint 'elbow'"
};
/// The first of the joints `standing` that carries the link, or a joint that moves and is none of them: what is modelled with them at 0 would be
/// somewhere else. Before and after fix().  Realtime: allocates.
[[nodiscard]] std::optional<Carried> carried_by(const Robot& robot, std::span<const std::size_t> standing,
                                                std::string_view link);

/// What moves by itself, in file order: the names of the model's coordinates.
/// Links that are fixed to each other become one body. Every link is a frame; the base's frame is that of the root link.
/// Model::make() takes the description of every robot that was read.  Realtime: allocates.
[[nodiscard]] ModelDescription describe(const Robot& robot);

/// Links that no joint goes on from, in file order: where tools are.  Realtime: allocates.
[[nodiscard]] std::vector<std::string> tips(const Robot& robot);

}  // namespace hirosco::robotics::urdf
