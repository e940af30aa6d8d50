// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>

#include "robotics/dynamics/dynamics.hpp"

/// Robots that have closed forms, and one at random.
namespace hirosco::robotics::testing {

[[nodiscard]] inline Inertia ball(double mass, const Vector3& centre, double moment = 0) {
  return {mass, centre, moment * Matrix3::Identity()};
}

[[nodiscard]] inline JointDescription joint(JointKind kind, const Vector3& axis, const Vector3& at,
                                            const Inertia& moved, std::optional<std::size_t> parent = {}) {
  JointDescription result;
  result.name = "J";
  result.kind = kind;
  result.axis = axis;
  result.placement.position = at;
  result.moved = moved;
  result.parent = parent;
  return result;
}

[[nodiscard]] inline Model make(const ModelDescription& description) { return Model::make(description).value(); }

[[nodiscard]] inline State state(std::initializer_list<double> q, std::initializer_list<double> qd) {
  State result;
  result.q = Eigen::Map<const Eigen::VectorXd>(q.begin(), static_cast<Eigen::Index>(q.size()));
  result.qd = Eigen::Map<const Eigen::VectorXd>(qd.begin(), static_cast<Eigen::Index>(qd.size()));
  return result;
}

/// A tree with branches, of both kinds of joints with any axes and full inertias; every third joint mimics the first one
/// where that is wanted. Its last frame is at the end of a branch.
enum class Mimicry : std::uint8_t { None, EveryThird };
[[nodiscard]] inline Model tree(int joints, Mimicry mimicry) {
  std::mt19937 random{7};
  std::uniform_real_distribution<double> any{-1, 1};
  const auto vector = [&] { return Vector3{any(random), any(random), any(random)}; };
  const auto body = [&] {
    const Matrix3 root = Matrix3::NullaryExpr([&] { return any(random); });
    return Inertia{2 + any(random), 0.2 * vector(), 0.1 * (root * root.transpose() + Matrix3::Identity())};
  };
  ModelDescription description;
  description.base = body();
  for (int i = 0; i < joints; ++i) {
    auto next =
        joint(i % 4 == 3 ? JointKind::Prismatic : JointKind::Revolute, vector().normalized(), 0.4 * vector(), body());
    next.placement.rotation =
        Quaternion{Eigen::Vector4d{any(random), any(random), any(random), any(random)}.normalized()}.toRotationMatrix();
    if (i > 0) next.parent = static_cast<std::size_t>(i % 5 == 4 ? i / 2 : i - 1);
    if (mimicry == Mimicry::EveryThird && i % 3 == 2) next.mimic = Mimic{0, -0.5, 0.2};
    next.damping = 0.3;
    description.joints.push_back(next);
  }
  description.frames.push_back({"tip", static_cast<std::size_t>(joints - 1), {Matrix3::Identity(), {0.1, 0.2, 0.3}}});
  return make(description);
}

/// Any state of a model, moving.
[[nodiscard]] inline State any_state(const Model& model, unsigned seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> any{-1, 1};
  State state;
  state.base_position = Vector3::NullaryExpr([&] { return 3 * any(random); });
  state.base_orientation = Quaternion{Eigen::Vector4d{any(random), any(random), any(random), any(random)}.normalized()};
  state.base_twist = Vector6::NullaryExpr([&] { return any(random); });
  state.q = JointVector::NullaryExpr(model.joint_count(), [&] { return 2 * any(random); });
  state.qd = JointVector::NullaryExpr(model.joint_count(), [&] { return any(random); });
  return state;
}

}  // namespace hirosco::robotics::testing
