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
  const robotics::Pose tip = dynamics_.frame_pose(tip_);
  HIROSCO_TRY(let_base_go());
  heavier_ = 1;
  if (payload_.mass_kg > 0) {
    add_payload(tip);
    HIROSCO_TRY(let_base_go());
  }
  take_tool(tip);
  const int joints = model_->joint_count();
  fixed_ = jacobian_.rightCols(joints);
  for (int i = 0; i < joints; ++i) free_.col(i) = fixed_.col(i) + jacobian_.leftCols<6>() * base_.col(i);
  return ok();
}

/// What base and joints are to each other, by the mass matrix.
Result<> FloatingModel::let_base_go() noexcept {
  const int joints = model_->joint_count();
  const Eigen::LLT<robotics::Matrix6> of_base{robotics::Matrix6{mass_.topLeftCorner<6, 6>()}};
  if (of_base.info() != Eigen::Success)
    return fail(ErrorCode::OutOfRange, "the robot has no inertia against a rotation");
  for (int i = 0; i < joints; ++i) base_.col(i) = -of_base.solve(Vector6{mass_.block<6, 1>(0, 6 + i)});
  for (int i = 0; i < joints; ++i)
    for (int j = 0; j < joints; ++j)
      inertia_(i, j) = mass_(6 + i, 6 + j) + mass_.block<6, 1>(0, 6 + i).dot(base_.col(j));
  return ok();
}

/// A point with mass is as much inertia as its place is moved by each coordinate. How much heavier it makes what joints move is reckoned for a base that gives way as without it, which is never
/// less than what it is.
void FloatingModel::add_payload(const robotics::Pose& tip) noexcept {
  const Vector3 lever = tip.rotation * payload_.place_m;
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, robotics::max_coordinates> of_place;
  of_place.resize(3, jacobian_.cols());
  for (Eigen::Index i = 0; i < jacobian_.cols(); ++i) {
    const Vector3 turning = jacobian_.col(i).head<3>();
    of_place.col(i) = jacobian_.col(i).tail<3>() + turning.cross(lever);
  }
  Rows of_free(3, model_->joint_count());
  for (Eigen::Index i = 0; i < of_free.cols(); ++i)
    of_free.col(i) = of_place.col(6 + i) + of_place.leftCols<6>() * base_.col(i);
  const Eigen::LLT<Square> felt{inertia_};
  robotics::Matrix3 moved;
  for (int axis = 0; axis < 3; ++axis) {
    const JointVector along = felt.solve(JointVector{of_free.row(axis).transpose()});
    for (int other = 0; other < 3; ++other) moved(other, axis) = of_free.row(other).dot(along);
  }
  const Eigen::SelfAdjointEigenSolver<robotics::Matrix3> solver{moved, Eigen::EigenvaluesOnly};
  heavier_ = 1 + payload_.mass_kg * solver.eigenvalues()[2];
  mass_.noalias() += (payload_.mass_kg * of_place.transpose()).lazyProduct(of_place);
}

/// The same motions, told of the tool's place.
void FloatingModel::take_tool(const robotics::Pose& tip) noexcept {
  tool_ = tip * in_tip_;
  const Vector3 lever = tip.rotation * in_tip_.position;
  for (Eigen::Index i = 0; i < jacobian_.cols(); ++i) {
    const Vector3 turning = jacobian_.col(i).head<3>();
    jacobian_.col(i).tail<3>() += turning.cross(lever);
  }
}

/// What the base takes goes over to the joints by what they do to it.
JointVector FloatingModel::bias(const JointVector& velocity) noexcept {
  state_.qd = velocity;
  state_.base_twist = base_ * velocity;
  dynamics_.update(state_);
  state_.qd.setZero();
  state_.base_twist.setZero();
  const int joints = model_->joint_count();
  robotics::Coordinates force;
  dynamics_.bias(force);
  Law::add_payload(payload_, tip_, Vector3::Zero(), dynamics_, robotics::Coordinates::Zero(6 + joints), force);
  JointVector of_joints = force.tail(joints);
  const Vector6 of_base = force.head<6>();
  of_joints.noalias() += base_.transpose().lazyProduct(of_base);
  return of_joints;
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
