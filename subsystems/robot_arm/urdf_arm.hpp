// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robotics/dynamics/model.hpp"
#include "robotics/urdf/named_robot.hpp"
#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// What an arm, on whatever base, knows of itself by the URDF file that the setting MODEL_FILE of its device names, and by the settings beside it:
/// links and joints, the limits of these, and which link is its tip.
class UrdfArm {
 public:
  /// Whose settings are read.
  static constexpr std::string_view device = "ARM";
  /// Where it was read.
  struct Source {
    std::filesystem::path file;
    std::string text;  ///< of the file
    std::vector<std::string> standing;  ///< joints of it that are somebody else's
  };

  UrdfArm() = default;
  /// The words of an error that it gave live as long as it does, where it is.
  UrdfArm(const UrdfArm&) = delete;
  UrdfArm& operator=(const UrdfArm&) = delete;

  /// The file, and which of its links is the tip; take_bounds() follows.  Realtime: allocates. Thread: the service loop.
  [[nodiscard]] Result<Source> read(const descriptor::SubsystemDescriptor& subsystem);
  /// Limits of the URDF file; those that a joint must have are asked for by name.  Realtime: allocates. Thread: the service loop.
  [[nodiscard]] Result<> take_bounds();
  /// What the file does not say of the joints' motions: rad/s2 or m/s2, and rad/s3 or m/s3, the same for all.
  void limit_motions(double acceleration, double jerk) noexcept;
  /// Likewise, by its velocity: each joint has it in so many s, and its acceleration in such a share of them.
  void limit_motions_by_velocity(double span_s, double ramp_share) noexcept;

  /// From read() on.
  [[nodiscard]] const robotics::Model& model() const noexcept { return *model_; }
  [[nodiscard]] robotics::FrameId tip() const noexcept { return tip_; }
  /// From take_bounds() on; who keeps them has them as they are.
  [[nodiscard]] Bounds bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::size_t joints() const noexcept { return bounds_.size(); }

 private:
  std::optional<robotics::Model> model_;
  robotics::FrameId tip_;
  robotics::urdf::NotRead not_read_;  ///< of its file or settings, for whoever reads the refusal
  std::vector<JointBounds> bounds_;
};

}  // namespace hirosco::robot_arm
