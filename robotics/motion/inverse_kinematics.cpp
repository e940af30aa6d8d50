// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/motion/inverse_kinematics.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hirosco::robotics {
namespace {

/// In one iteration a tip is moved by no more: a Jacobian holds for small ways.
constexpr double longest_step = 0.3;

[[nodiscard]] Vector3 rotation_vector(const Matrix3& rotation) noexcept {
  const Eigen::AngleAxisd turned{rotation};
  return turned.angle() * turned.axis();
}

/// How much of a velocity a joint may have that is so near to a limit: 0 to 1.
[[nodiscard]] double share(const JointLimits& limits, double q, double qd, double margin) noexcept {
  const double left = qd > 0 ? limits.upper.value_or(INFINITY) - q : q - limits.lower.value_or(-INFINITY);
  return std::clamp(left / margin, 0.0, 1.0);
}

}  // namespace

InverseKinematics::InverseKinematics(const Model& model, FrameId tip, const InverseKinematicsOptions& options)
    : model_{&model}, tip_{tip}, options_{options}, dynamics_{model, Base::Fixed} {
  state_.qd.setZero(model.joint_count());
}

void InverseKinematics::rates(Dynamics& dynamics, const Vector6& twist, const JointVector& q,
                              const JointVector& posture, JointVector& qd) const noexcept {
  const int joints = model_->joint_count();
  Jacobian jacobian;
  if (!dynamics.generalised_jacobian(tip_, jacobian)) {
    qd.setZero(joints);
    return;
  }
  const JointVector towards = options_.posture_gain * (posture - q);
  JointVector weight = JointVector::Ones(joints);
  // Who goes towards a limit counts for less, and then others do it; each time fewer joints are left.
  for (int pass = 0; pass <= joints; ++pass) {
    Jacobian weighted = jacobian;
    for (int i = 0; i < joints; ++i) weighted.col(i) *= weight[i];
    Matrix6 square;
    square.noalias() = weighted.lazyProduct(jacobian.transpose());
    const Eigen::SelfAdjointEigenSolver<Matrix6> parts{square};
    const double smallest = std::sqrt(std::max(0.0, parts.eigenvalues()[0])) / options_.singular;
    const double damping = smallest < 1 ? (1 - smallest * smallest) * options_.damping * options_.damping : 0;
    const auto inverse = [&](const Vector6& wanted) {
      Vector6 along = parts.eigenvectors().transpose() * wanted;
      for (int i = 0; i < 6; ++i) {
        const double value = std::max(0.0, parts.eigenvalues()[i]) + damping;
        along[i] = value > 0 ? along[i] / value : 0;
      }
      return Vector6{parts.eigenvectors() * along};
    };
    const Vector6 drawn = jacobian.lazyProduct(weight.cwiseProduct(towards));
    qd = weight.cwiseProduct(towards);
    qd.noalias() += weighted.transpose().lazyProduct(inverse(twist - drawn));
    bool more = false;
    for (int i = 0; i < joints; ++i) {
      const double least = share(model_->joints()[static_cast<std::size_t>(i)].limits, q[i], qd[i], options_.margin);
      if (least >= weight[i]) continue;
      weight[i] = least;
      more = true;
    }
    if (!more) return;
  }
}

Vector6 InverseKinematics::left(const Pose& tip, const JointVector& q) noexcept {
  state_.q = q;
  dynamics_.update(state_);
  const Pose now = dynamics_.frame_pose(tip_);
  Vector6 left;
  left.head<3>() = rotation_vector(tip.rotation * now.rotation.transpose());
  left.tail<3>() = tip.position - now.position;
  return left;
}

double InverseKinematics::smallest_singular_value(const JointVector& q) noexcept {
  state_.q = q;
  dynamics_.update(state_);
  Jacobian jacobian;
  if (!dynamics_.generalised_jacobian(tip_, jacobian)) return 0;
  Matrix6 square;
  square.noalias() = jacobian.lazyProduct(jacobian.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix6> parts{square, Eigen::EigenvaluesOnly};
  return std::sqrt(std::max(0.0, parts.eigenvalues()[std::max(0, 6 - model_->joint_count())]));
}

Result<int> InverseKinematics::solve(const Pose& tip, const JointVector& posture, JointVector& q) noexcept {
  const auto joints = model_->joints();
  JointVector qd;
  for (int iteration = 0; iteration <= options_.most_iterations; ++iteration) {
    Vector6 error = left(tip, q);
    const bool there = error.cwiseAbs().maxCoeff() <= options_.tolerance;
    if (there && !std::isfinite(options_.settled)) return iteration;
    if (!there) error *= std::min(1.0, longest_step / error.norm());
    rates(dynamics_, error, q, posture, qd);
    if (there && qd.cwiseAbs().maxCoeff() <= options_.settled) return iteration;
    q += qd * std::min(1.0, longest_step * 2 / std::max(qd.cwiseAbs().maxCoeff(), 1e-12));
    for (int i = 0; i < model_->joint_count(); ++i) {
      const JointLimits& limits = joints[static_cast<std::size_t>(i)].limits;
      q[i] = std::clamp(q[i], limits.lower.value_or(-INFINITY), limits.upper.value_or(INFINITY));
    }
  }
  return fail(ErrorCode::Unavailable, "the place was not reached", options_.most_iterations);
}

}  // namespace hirosco::robotics
