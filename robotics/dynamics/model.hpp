// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/utilities/result.hpp"
#include "robotics/dynamics/spatial.hpp"

namespace hirosco::robotics {

/// Joints that move by themselves, at most.
inline constexpr int max_joints = 16;
/// Bodies that joints move, at most: those of mimic joints besides.
inline constexpr int max_moved_bodies = 32;
/// Coordinates of a free robot, at most.
inline constexpr int max_coordinates = 6 + max_joints;

enum class JointKind : std::uint8_t { Revolute, Prismatic };

/// A joint that follows another: q = multiplier q_joint + offset.
struct Mimic {
  std::size_t joint{0};                      ///< index among the described joints; itself no mimic
  double multiplier{1};                      ///< not 0
  double offset{0};                          ///< rad or m
};

/// What a joint may do. Nothing here is enforced by the equations of motion.
struct JointLimits {
  std::optional<double> lower;               ///< rad or m; nothing: turns on and on
  std::optional<double> upper;
  std::optional<double> velocity;            ///< rad/s or m/s
  std::optional<double> effort;              ///< N m or N
  std::optional<double> acceleration{};      ///< rad/s2 or m/s2, above 0; few files have it
  std::optional<double> jerk{};              ///< rad/s3 or m/s3, likewise
};

/// A joint and the body that it moves. Its frame is fixed in that body.
struct JointDescription {
  std::string name;
  JointKind kind{JointKind::Revolute};
  std::optional<std::size_t> parent;         ///< joint whose body carries this one; nothing: the base does
  Pose placement;                            ///< of the joint's frame at q = 0 in the frame of the carrying body
  Vector3 axis{Vector3::UnitX()};            ///< in the joint's frame, of length 1
  Inertia moved;                             ///< in the joint's frame
  std::optional<Mimic> mimic;
  double damping{0};                         ///< N m s/rad or N s/m, at least 0
  double friction{0};                        ///< Coulomb, N m or N, at least 0; not part of the equations of motion
  JointLimits limits;
};

/// A place on a body that has a name: a link, a tool.
struct FrameDescription {
  std::string name;
  std::optional<std::size_t> joint;          ///< whose body it is on; nothing: the base
  Pose placement;                            ///< in that joint's frame
};

/// A robot as a tree of bodies. The base is what carries all; its frame is the robot's own.
struct ModelDescription {
  Inertia base;                              ///< in the base's frame
  std::vector<JointDescription> joints;  ///< in any order; coordinates are numbered in this one, mimic joints left out
  std::vector<FrameDescription> frames;
};

/// Whether a body may have this: mass at least 0, moments positive semi-definite but for rounding.  Realtime: bounded.
[[nodiscard]] bool is_body(const Inertia& inertia) noexcept;

/// A frame of a model. Of that model only.
struct FrameId {
  std::size_t index{0};
};

/// A robot that can be reckoned with: checked, in an order that the algorithms want. Never changes.
class Model {
 public:
  /// `Error::value` is the index of the joint that is wrong. Refused: no joint or more than there is room for; circles; axes
  /// that are not of length 1; negative masses, damping or friction; inertias that are not positive semi-definite; numbers that
  /// are none; mimic joints of nobody, or of a mimic joint; frames on nobody.  Realtime: allocates.
  [[nodiscard]] static Result<Model> make(const ModelDescription& description);

  /// How a body hangs in the tree. Bodies stand behind what carries them; the base is 0. The axis of a joint is z of its body's
  /// frame, which saves the algorithms a multiplication wherever it occurs.
  struct Body {
    std::size_t parent{0};
    JointKind kind{JointKind::Revolute};
    int coordinate{0};  ///< of the joint, from 0
    double multiplier{1};  ///< of a mimic joint, else 1
    double offset{0};
    Pose placement;  ///< at q = 0 in the parent's frame
    Inertia inertia;  ///< in its own frame
  };
  struct Joint {
    std::string name;
    JointKind kind{JointKind::Revolute};
    double damping{0};  ///< with that of the joints that mimic it
    double friction{0};
    JointLimits limits;  ///< such that those of the joints that mimic it hold, too
  };
  struct Frame {
    std::string name;
    std::size_t body{0};
    Pose placement;
  };

  [[nodiscard]] int joint_count() const noexcept { return static_cast<int>(joints_.size()); }
  [[nodiscard]] std::span<const Joint> joints() const noexcept { return joints_; }
  [[nodiscard]] std::span<const Body> bodies() const noexcept { return bodies_; }
  [[nodiscard]] std::span<const Frame> frames() const noexcept { return frames_; }
  [[nodiscard]] const Frame& frame(FrameId id) const noexcept { return frames_[id.index]; }
  [[nodiscard]] bool has_mimic() const noexcept { return has_mimic_; }
  [[nodiscard]] double mass() const noexcept { return mass_; }
  /// Realtime: bounded. NotFound.
  [[nodiscard]] Result<FrameId> find_frame(std::string_view name) const noexcept;

 private:
  Model() = default;
  std::vector<Body> bodies_;
  std::vector<Joint> joints_;
  std::vector<Frame> frames_;
  double mass_{0};
  bool has_mimic_{false};
};

}  // namespace hirosco::robotics
