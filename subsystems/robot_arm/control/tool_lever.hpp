// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// What joints and the point of the tool are to each other in one posture: which force there goes with such torques, and how fast it goes.
class ToolLever {
 public:
  /// `dynamics` was updated with the posture; `tool_m`: where the tool is in the tip's frame.
  void update(const robotics::Dynamics& dynamics, robotics::FrameId tip, const Vector3& tool_m) noexcept;
  /// Likewise by how fast joint velocities have the tool go: of an arm whose base gives way. Axes are those of what is given.
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, robotics::max_joints>;
  void update(const Rows& place) noexcept;
  /// N, in the axes of the base: the one force at the tool that explains these torques best. Along a direction in which joints move the tool
  /// less than 0.02 m by a radian it is the less told the less they do: there links bear it, and no joint feels it.
  [[nodiscard]] Vector3 force(const JointVector& torque) const noexcept;
  /// m/s, in the axes of the base.
  [[nodiscard]] Vector3 velocity(const JointVector& rates) const noexcept;

 private:
  void weigh() noexcept;

  Rows place_;
  Eigen::LLT<robotics::Matrix3> factors_;
};

}  // namespace hirosco::robot_arm
