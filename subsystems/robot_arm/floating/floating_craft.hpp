// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/subsystem/author/ports.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/floating/base_estimate.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/floating/tool_law.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// A craft with an arm as it floats: where its base and its tool are, by joints that are measured and the pose that somebody else measures where the
/// law in force keeps to it, and what it does when joints move.
/// Realtime: bounded, but begin(). Thread: the cycle, and the service loop while there is none.
class FloatingCraft {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    FloatingParameters& parameters;  ///< TOOL, BASE_PRED and SIGMA_MIN tell what it finds
  };
  explicit FloatingCraft(const Parts& parts) noexcept : parts_{parts} {}

  /// For require_link().
  [[nodiscard]] LinkInputPort& pose_port() noexcept { return pose_; }
  /// In configure().  Realtime: allocates. Thread: the service loop.
  void begin(ToolLaw law, double cycle_s);
  [[nodiscard]] bool begun() const noexcept { return model_.has_value(); }
  /// What is at its tip from now on, where it stands: as of FloatingModel. Behind drives that were forgotten.
  void carry(const robotics::Pose& tool_in_tip, const Payload& payload) noexcept;
  /// Takes joints that are measured, and pose, and tells what follows.
  void update() noexcept;

  /// In force, as long as the configuration is.
  [[nodiscard]] ToolLaw law() const noexcept { return law_; }
  /// It keeps to inertial axes, by the pose of the base.
  [[nodiscard]] bool tracks() const noexcept { return law_ != ToolLaw::FixedBase; }
  /// Somebody's actuators act on the base, and that matters.
  [[nodiscard]] bool base_is_held() const noexcept { return tracks() && pose_.valid() && pose_.value().free == 0; }

  /// As of FloatingModel, with velocities as measured; of update().
  [[nodiscard]] JointVector bias() noexcept { return model_->bias(parts_.drives.measured().velocity); }

  // --- of update(), inertial axes -----------------------------------------------------------------------------------------
  [[nodiscard]] const FloatingModel& model() const noexcept { return *model_; }
  [[nodiscard]] const robotics::Pose& tool() const noexcept { return model_->tool(); }
  /// How fast joints follow velocities, 1/s, with what is at the tip.
  [[nodiscard]] double followed_per_s() const noexcept { return followed_with(model_->heavier(), cycle_s_); }
  /// Of the base.
  [[nodiscard]] robotics::Matrix3 attitude() const noexcept { return base_.orientation().toRotationMatrix(); }
  [[nodiscard]] robotics::Pose base() const noexcept { return {attitude(), base_.position_m()}; }

 private:
  void follow_base() noexcept;
  void find() noexcept;

  Parts parts_;
  LinkInput<BasePose> pose_;
  std::optional<FloatingModel> model_;
  BaseEstimate base_;
  ToolLaw law_{ToolLaw::FixedBase};
  double cycle_s_{0.001};
};

}  // namespace hirosco::robot_arm
