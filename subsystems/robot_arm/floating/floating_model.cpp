// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace hirosco::robot_arm {
namespace {

/// A base that turns by 0.1 rad counts as much as a tool that moves by 1 m.
constexpr double base_counts = 10;

}  // namespace

FloatingModel::FloatingModel(const robotics::Model& model, robotics::FrameId tip)
    : model_{&model}, tip_{tip}, dynamics_{model, robotics::Base::Free} {
  const int joints = model.joint_count();
  state_.q.setZero(joints);
  state_.qd.setZero(joints);
  free_.setZero(6, joints);
  fixed_ = base_ = free_;
  inertia_.setIdentity(joints, joints);
}

Result<> FloatingModel::update(const robotics::Pose& base, const JointVector& position) noexcept {
  state_.base_position = base.position;
  state_.base_orientation = robotics::Quaternion{base.rotation};
  state_.q = position;
  dynamics_.update(state_);
  dynamics_.mass_matrix(mass_);
  dynamics_.jacobian(tip_, jacobian_);
  tool_ = dynamics_.frame_pose(tip_);
  const int joints = model_->joint_count();
  const Eigen::LLT<robotics::Matrix6> of_base{robotics::Matrix6{mass_.topLeftCorner<6, 6>()}};
  if (of_base.info() != Eigen::Success)
    return fail(ErrorCode::OutOfRange, "the robot has no inertia against a rotation");
  for (int i = 0; i < joints; ++i) base_.col(i) = -of_base.solve(Vector6{mass_.block<6, 1>(0, 6 + i)});
  fixed_ = jacobian_.rightCols(joints);
  for (int i = 0; i < joints; ++i) free_.col(i) = fixed_.col(i) + jacobian_.leftCols<6>() * base_.col(i);
  for (int i = 0; i < joints; ++i)
    for (int j = 0; j < joints; ++j)
      inertia_(i, j) = mass_(6 + i, 6 + j) + mass_.block<6, 1>(0, 6 + i).dot(base_.col(j));
  return ok();
}

double FloatingModel::conditioning() const noexcept {
  Twists both = free_;
  both.topRows<3>() = base_counts * base_.topRows<3>();
  both.bottomRows<3>() = free_.bottomRows<3>();
  robotics::Matrix6 square;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) square(i, j) = both.row(i).dot(both.row(j));
  const Eigen::SelfAdjointEigenSolver<robotics::Matrix6> solver{square, Eigen::EigenvaluesOnly};
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

}  // namespace hirosco::robot_arm
