// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/tool_kinematics.hpp"

namespace hirosco::robot_arm {

ToolKinematics::ToolKinematics(const robotics::Model& model, robotics::FrameId tip)
    : tip_{tip}, dynamics_{model, robotics::Base::Fixed} {
  state_.qd.setZero(model.joint_count());
}

robotics::Pose ToolKinematics::pose(const JointVector& position) noexcept {
  state_.q = position;
  dynamics_.update(state_);
  return dynamics_.frame_pose(tip_) * in_tip_;
}

JointVector ToolKinematics::rates(const robotics::InverseKinematics& kinematics, const Vector6& twist,
                                  const JointVector& position, const JointVector& posture) noexcept {
  state_.q = position;
  dynamics_.update(state_);
  // The same motion, told of the tip's origin.
  const Vector3 lever = dynamics_.frame_pose(tip_).rotation * in_tip_.position;
  Vector6 of_tip = twist;
  const Vector3 turning = twist.head<3>();
  of_tip.tail<3>() -= turning.cross(lever);
  JointVector rates;
  kinematics.rates(dynamics_, of_tip, position, posture, rates);
  return rates;
}

}  // namespace hirosco::robot_arm
