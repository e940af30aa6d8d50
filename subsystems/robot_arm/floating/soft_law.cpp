// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/soft_law.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// What no spring has comes to rest as fast, as of the arm that stands.
constexpr double free_damping_per_s = 2;

/// The tool's Jacobian in the axes of its goal.
[[nodiscard]] const FloatingModel::Twists& tool_of(ToolLaw law, const FloatingModel& model) noexcept {
  return law == ToolLaw::FixedBase ? model.tool_of_fixed() : model.tool_of_free();
}

/// A spring to the place, and one to the orientation whose potential is k (1 - cos angle): it has no step anywhere.
[[nodiscard]] Vector6 wrench_of(const Impedance& impedance, const robotics::Pose& is,
                                const robotics::Pose& goal) noexcept {
  Vector3 turn = Vector3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 one = is.rotation.col(axis), other = goal.rotation.col(axis);
    turn += 0.5 * one.cross(other);
  }
  Vector6 wrench;
  wrench.head<3>() = impedance.tool_n_m_rad * turn;
  wrench.tail<3>() = impedance.tool_n_m * (goal.position - is.position);
  return wrench;
}

}  // namespace

void SoftLaw::begin(Eigen::Index joints) noexcept { impedance_.joint_n_m_rad.setZero(joints); }

/// With A = L^-1 K L^-T of K, the springs as joints feel them, and H* = L L': its eigenvalues are the squares of what swings, its eigenvectors the ways.
void SoftLaw::find_ways(LawKind kind, ToolLaw law, const Impedance& impedance, const FloatingModel& model) noexcept {
  const Eigen::Index joints = model.inertia().rows();
  springs_.setZero(joints, joints);
  if (kind == LawKind::JointImpedance) {
    springs_.diagonal() = impedance.joint_n_m_rad;
  } else {
    const FloatingModel::Twists& tool = tool_of(law, model);
    for (int axis = 0; axis < 6; ++axis) {
      const JointVector row = tool.row(axis).transpose();
      springs_.noalias() += (axis < 3 ? impedance.tool_n_m_rad : impedance.tool_n_m) * row.lazyProduct(row.transpose());
    }
  }
  moved_.compute(model.inertia());
  factor_ = moved_.matrixL();
  for (Eigen::Index i = 0; i < joints; ++i) {
    JointVector column = springs_.col(i);
    factor_.triangularView<Eigen::Lower>().solveInPlace(column);
    springs_.col(i) = column;
  }
  for (Eigen::Index i = 0; i < joints; ++i) {
    JointVector row = springs_.row(i).transpose();
    factor_.triangularView<Eigen::Lower>().solveInPlace(row);
    springs_.row(i) = row.transpose();
  }
  ways_ = 0.5 * (springs_ + springs_.transpose());
  swings_.compute(ways_);
}

JointVector SoftLaw::damped(const JointVector& slower, double strongest_per_s) const noexcept {
  const FloatingModel::Square& ways = swings_.eigenvectors();
  JointVector along = JointVector::Zero(slower.size());
  for (Eigen::Index i = 0; i < slower.size(); ++i) along += slower[i] * factor_.row(i).transpose();
  JointVector sum = JointVector::Zero(slower.size());
  for (Eigen::Index i = 0; i < slower.size(); ++i) {
    const double swings = std::sqrt(std::max(0.0, swings_.eigenvalues()[i]));
    const double per_s = std::min(std::max(free_damping_per_s, 2 * impedance_.damping_ratio * swings), strongest_per_s);
    sum += per_s * ways.col(i).dot(along) * ways.col(i);
  }
  JointVector torque = JointVector::Zero(slower.size());
  for (Eigen::Index i = 0; i < slower.size(); ++i) torque[i] = factor_.row(i).dot(sum);
  return torque;
}

JointVector SoftLaw::torque(LawKind kind, ToolLaw law, const FloatingModel& model, const Measured& measured,
                            const SoftGoal& goal, Bounds bounds, double strongest_per_s) noexcept {
  find_ways(kind, law, impedance_, model);
  if (kind == LawKind::JointImpedance) {
    const JointVector behind = goal.joints.position - measured.position;
    return damped(goal.joints.velocity - measured.velocity, strongest_per_s) +
           impedance_.joint_n_m_rad.cwiseProduct(behind);
  }
  // Where the tool is its goal: what is left are joint velocities of the goal's.
  const ToolGoal moves{model.tool(), goal.tool.velocity_m_s, goal.tool.turning_rad_s};
  const robotics::Matrix3 upright = robotics::Matrix3::Identity();
  const JointVector wanted = tool_rates(law, model, bounds, moves, upright, upright);
  const Vector6 wrench = wrench_of(impedance_, model.tool(), goal.tool.pose);
  JointVector torque = damped(wanted - measured.velocity, strongest_per_s);
  torque.noalias() += tool_of(law, model).transpose().lazyProduct(wrench);
  return torque;
}

double SoftLaw::swings_rad_s(LawKind kind, ToolLaw law, const Impedance& impedance,
                             const FloatingModel& model) noexcept {
  find_ways(kind, law, impedance, model);
  return std::sqrt(std::max(0.0, swings_.eigenvalues().maxCoeff()) * model.heavier());
}

}  // namespace hirosco::robot_arm
