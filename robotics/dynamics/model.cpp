// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/dynamics/model.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace hirosco::robotics {
namespace {

/// How far from length 1 an axis, and from a rotation a matrix, may be.
constexpr double unit_tolerance = 1e-9;
/// An eigenvalue may be as far below 0 as numbers with six digits bring it.
constexpr double definite_tolerance = 1e-6;

[[nodiscard]] bool is_pose(const Pose& pose) {
  return pose.position.allFinite() && pose.rotation.allFinite() &&
         (pose.rotation * pose.rotation.transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff() <= unit_tolerance &&
         pose.rotation.determinant() > 0;
}

[[nodiscard]] bool is_limit(std::optional<double> limit) { return !limit || std::isfinite(*limit); }

Result<> check(const JointDescription& joint, const ModelDescription& all, std::int64_t index) {
  const auto wrong = [index](const char* text) { return fail(ErrorCode::InvalidArgument, text, index); };
  if (joint.parent && *joint.parent >= all.joints.size()) return wrong("the joint that carries it does not exist");
  if (!joint.axis.allFinite() || std::abs(joint.axis.norm() - 1) > unit_tolerance)
    return wrong("the axis is not of length 1");
  if (!is_pose(joint.placement)) return wrong("the placement is no pose");
  if (!is_body(joint.moved)) return wrong("the inertia is not that of a body");
  if (!(joint.damping >= 0) || !std::isfinite(joint.damping)) return wrong("the damping is negative or no number");
  if (!(joint.friction >= 0) || !std::isfinite(joint.friction)) return wrong("the friction is negative or no number");
  if (!is_limit(joint.limits.lower) || !is_limit(joint.limits.upper) || !is_limit(joint.limits.velocity) ||
      !is_limit(joint.limits.effort) || !is_limit(joint.limits.acceleration) || !is_limit(joint.limits.jerk))
    return wrong("a limit is no number");
  if (!joint.mimic) return ok();
  const Mimic& mimic = *joint.mimic;
  if (mimic.joint >= all.joints.size()) return wrong("the joint that it mimics does not exist");
  if (all.joints[mimic.joint].mimic) return wrong("the joint that it mimics is a mimic joint itself");
  if (!std::isfinite(mimic.multiplier) || mimic.multiplier == 0 || !std::isfinite(mimic.offset))
    return wrong("the multiplier is 0, or it or the offset no number");
  return ok();
}

/// Joints behind those that carry them, as near to the given order as can be. Empty: there is a circle.
[[nodiscard]] std::vector<std::size_t> ordered(const std::vector<JointDescription>& joints) {
  std::vector<std::size_t> order;
  std::vector<bool> taken(joints.size(), false);
  for (bool more = true; more && order.size() < joints.size();) {
    more = false;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (taken[i] || (joints[i].parent && !taken[*joints[i].parent])) continue;
      taken[i] = more = true;
      order.push_back(i);
    }
  }
  return order.size() == joints.size() ? order : std::vector<std::size_t>{};
}

/// Where the frame of the body stands in the joint's: turned such that z is the axis. Exact for axes that are those of the frame.
[[nodiscard]] Matrix3 along(const Vector3& axis) {
  if (axis == Vector3::UnitZ()) return Matrix3::Identity();
  Eigen::Index across = 0;
  axis.cwiseAbs().minCoeff(&across);
  const Vector3 other = Vector3::Unit(across);
  Matrix3 turned;
  turned.col(0) = (other - other.dot(axis) * axis).normalized();
  turned.col(1) = axis.cross(turned.col(0));
  turned.col(2) = axis;
  return turned;
}

/// The mimicked joint must stay where the mimic joint is within its limits, too.
void narrow(JointLimits& limits, const JointLimits& other, const Mimic& mimic) {
  const auto tighter = [](std::optional<double>& limit, double value, bool from_above) {
    if (!limit || (from_above ? value < *limit : value > *limit)) limit = value;
  };
  for (const auto& [bound, is_upper] : {std::pair{other.lower, false}, std::pair{other.upper, true}}) {
    if (!bound) continue;
    const double value = (*bound - mimic.offset) / mimic.multiplier;
    const bool from_above = is_upper == (mimic.multiplier > 0);
    tighter(from_above ? limits.upper : limits.lower, value, from_above);
  }
  for (const auto& [limit, its] : {std::pair{&limits.velocity, other.velocity},
                                   {&limits.acceleration, other.acceleration},
                                   {&limits.jerk, other.jerk}})
    if (its) tighter(*limit, *its / std::abs(mimic.multiplier), true);
}

}  // namespace

bool is_body(const Inertia& inertia) noexcept {
  if (!std::isfinite(inertia.mass) || inertia.mass < 0 || !inertia.centre.allFinite() ||
      !inertia.about_centre.allFinite())
    return false;
  const double size = inertia.about_centre.cwiseAbs().maxCoeff();
  if ((inertia.about_centre - inertia.about_centre.transpose()).cwiseAbs().maxCoeff() > definite_tolerance * size)
    return false;
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver{inertia.about_centre, Eigen::EigenvaluesOnly};
  return solver.eigenvalues().minCoeff() >= -definite_tolerance * size;
}

Result<Model> Model::make(const ModelDescription& description) {
  const auto& joints = description.joints;
  const auto own =
      std::ranges::count_if(joints, [](const JointDescription& joint) { return !joint.mimic.has_value(); });
  if (own == 0) return fail(ErrorCode::InvalidArgument, "no joint moves by itself");
  if (own > max_joints) return fail(ErrorCode::ResourceExhausted, "more than 16 joints", own);
  if (joints.size() > max_moved_bodies)
    return fail(ErrorCode::ResourceExhausted, "more than 32 moved bodies", static_cast<std::int64_t>(joints.size()));
  if (!is_body(description.base))
    return fail(ErrorCode::InvalidArgument, "the inertia of the base is not that of a body", -1);
  for (std::size_t i = 0; i < joints.size(); ++i)
    HIROSCO_TRY(check(joints[i], description, static_cast<std::int64_t>(i)));
  const auto order = ordered(joints);
  if (order.empty()) return fail(ErrorCode::InvalidArgument, "joints carry each other in a circle");

  Model model;
  std::vector<int> coordinates(joints.size(), 0);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].mimic) continue;
    coordinates[i] = model.joint_count();
    model.joints_.push_back({joints[i].name, joints[i].kind, joints[i].damping, joints[i].friction, joints[i].limits});
  }
  std::vector<std::size_t> body_of(joints.size(), 0);
  std::vector<Matrix3> turned(joints.size() + 1, Matrix3::Identity());  // of bodies
  model.bodies_.emplace_back().inertia = description.base;
  for (const std::size_t i : order) {
    const JointDescription& joint = joints[i];
    Body body;
    body.parent = joint.parent ? body_of[*joint.parent] : 0;
    body.kind = joint.kind;
    body.coordinate = coordinates[joint.mimic ? joint.mimic->joint : i];
    body_of[i] = model.bodies_.size();
    const Matrix3 turn = turned[body_of[i]] = along(joint.axis);
    body.placement = Pose{turned[body.parent].transpose()} * joint.placement * Pose{turn};
    body.inertia = moved(Pose{turn.transpose()}, joint.moved);
    if (joint.mimic) {
      body.multiplier = joint.mimic->multiplier;
      body.offset = joint.mimic->offset;
      Joint& followed = model.joints_[static_cast<std::size_t>(body.coordinate)];
      followed.damping += joint.damping * body.multiplier * body.multiplier;
      followed.friction += joint.friction * std::abs(body.multiplier);
      narrow(followed.limits, joint.limits, *joint.mimic);
      model.has_mimic_ = true;
    }
    model.bodies_.push_back(body);
  }
  for (const FrameDescription& frame : description.frames) {
    if (frame.joint && *frame.joint >= joints.size())
      return fail(ErrorCode::InvalidArgument, "a frame is on a joint that does not exist",
                  static_cast<std::int64_t>(*frame.joint));
    if (!is_pose(frame.placement)) return fail(ErrorCode::InvalidArgument, "the placement of a frame is no pose");
    const std::size_t body = frame.joint ? body_of[*frame.joint] : 0;
    model.frames_.push_back({frame.name, body, Pose{turned[body].transpose()} * frame.placement});
  }
  for (const Body& body : model.bodies_) model.mass_ += body.inertia.mass;
  return model;
}

Result<FrameId> Model::find_frame(std::string_view name) const noexcept {
  const auto found = std::ranges::find(frames_, name, &Frame::name);
  if (found == frames_.end()) return fail(ErrorCode::NotFound, "no frame of this name");
  return FrameId{static_cast<std::size_t>(found - frames_.begin())};
}

}  // namespace hirosco::robotics
