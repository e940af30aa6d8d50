// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/tool_lever.hpp"

namespace hirosco::robot_arm {
namespace {

/// Of a lever so short as that half of a force is told.
constexpr double shortest_lever_m = 0.02;

}  // namespace

void ToolLever::update(const robotics::Dynamics& dynamics, robotics::FrameId tip, const Vector3& tool_m) noexcept {
  Jacobian jacobian;
  dynamics.jacobian(tip, jacobian);
  const Vector3 lever = dynamics.frame_pose(tip).rotation * tool_m;
  place_.resize(3, jacobian.cols());
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
    const Vector3 turning = jacobian.col(i).head<3>();
    place_.col(i) = jacobian.col(i).tail<3>() + turning.cross(lever);
  }
  weigh();
}

void ToolLever::update(const Rows& place) noexcept {
  place_ = place;
  weigh();
}

void ToolLever::weigh() noexcept {
  robotics::Matrix3 square;
  square.noalias() = place_.lazyProduct(place_.transpose());
  square.diagonal().array() += shortest_lever_m * shortest_lever_m;
  factors_.compute(square);
}

Vector3 ToolLever::force(const JointVector& torque) const noexcept {
  Vector3 sum;
  sum.noalias() = place_.lazyProduct(torque);
  return factors_.solve(sum);
}

Vector3 ToolLever::velocity(const JointVector& rates) const noexcept {
  Vector3 sum;
  sum.noalias() = place_.lazyProduct(rates);
  return sum;
}

}  // namespace hirosco::robot_arm
