// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robotics/motion/inverse_kinematics.hpp"
#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// Where the tool at an arm's tip is with its joints somewhere, and what these do to move it.
class ToolKinematics {
 public:
  ToolKinematics(const robotics::Model& model, robotics::FrameId tip);

  /// Where the tool is in the tip's frame; while nothing moves.
  void set_in_tip(const robotics::Pose& in_tip) noexcept { in_tip_ = in_tip; }
  [[nodiscard]] const robotics::Pose& in_tip() const noexcept { return in_tip_; }
  [[nodiscard]] robotics::Pose pose(const JointVector& position) noexcept;
  /// Where the tip is when the tool is there.
  [[nodiscard]] robotics::Pose tip_with(const robotics::Pose& tool) const noexcept {
    return tool * robotics::inverse(in_tip_);
  }
  /// Of the joints, for a twist [ω; v] of the tool in the axes of the base. Joints that it leaves free are drawn to `posture`.
  [[nodiscard]] JointVector rates(const robotics::InverseKinematics& kinematics, const Vector6& twist,
                                  const JointVector& position, const JointVector& posture) noexcept;

 private:
  robotics::FrameId tip_;
  robotics::Dynamics dynamics_;
  robotics::State state_;
  robotics::Pose in_tip_{};
};

}  // namespace hirosco::robot_arm
