// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/dynamics/dynamics.hpp"

#include <cassert>
#include <cmath>

namespace hirosco::robotics {
namespace {

/// An inertia against a joint's motion that is so much smaller than what the joint moves is none.
constexpr double no_inertia = 1e-13;

/// The rotation of a matrix about its own z.
void turn(Matrix3& rotation, double angle) noexcept {
  const double c = std::cos(angle), s = std::sin(angle);
  const Vector3 x = rotation.col(0), y = rotation.col(1);
  rotation.col(0) = c * x + s * y;
  rotation.col(1) = c * y - s * x;
}

/// The twist of a point that moves with a body, from the body's at the origin.
[[nodiscard]] Vector6 at_point(const Vector6& twist, const Vector3& point) noexcept {
  Vector6 shifted = twist;
  shifted.tail<3>() += twist.head<3>().cross(point);
  return shifted;
}

[[nodiscard]] Vector6 rotated(const Matrix3& rotation, const Vector6& twist) noexcept {
  Vector6 result;
  result.head<3>() = rotation * twist.head<3>();
  result.tail<3>() = rotation * twist.tail<3>();
  return result;
}

}  // namespace

Dynamics::Dynamics(const Model& model, Base base)
    : model_{&model},
      base_{base},
      first_joint_{base == Base::Free ? 6 : 0},
      bodies_(model.bodies().size()),
      by_matrix_{first_joint_ + model.joint_count()} {
  State at_rest;
  at_rest.q.setZero(model.joint_count());
  at_rest.qd.setZero(model.joint_count());
  update(at_rest);
}

void Dynamics::update(const State& state) noexcept {
  assert(state.q.size() == model_->joint_count() && state.qd.size() == model_->joint_count());
  base_position_ = state.base_position;
  base_rotation_ = state.base_orientation.toRotationMatrix();
  const auto bodies = model_->bodies();
  Moving& root = bodies_[0];
  root.axis.setZero();
  root.drift.setZero();
  root.inertia = OriginInertia{bodies[0].inertia};
  if (base_ == Base::Free) root.twist = state.base_twist;
  else root.twist.setZero();
  root.momentum = root.inertia * root.twist;

  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const Model::Body& body = bodies[i];
    const Moving& parent = bodies_[body.parent];
    Moving& moving = bodies_[i];
    const double q = body.multiplier * state.q[body.coordinate] + body.offset;
    Matrix3& rotation = moving.pose.rotation;
    rotation.noalias() = parent.pose.rotation.lazyProduct(body.placement.rotation);
    moving.pose.position = parent.pose.position;
    moving.pose.position.noalias() += parent.pose.rotation.lazyProduct(body.placement.position);
    const Vector3 z = body.multiplier * rotation.col(2);
    if (body.kind == JointKind::Revolute) {
      turn(rotation, q);
      moving.axis.head<3>() = z;
      moving.axis.tail<3>() = moving.pose.position.cross(z);
    } else {
      moving.pose.position += q * rotation.col(2);
      moving.axis.head<3>().setZero();
      moving.axis.tail<3>() = z;
    }
    const Vector6 moves = moving.axis * state.qd[body.coordinate];
    moving.twist = parent.twist + moves;
    moving.drift = cross_twist(parent.twist, moves);

    const Inertia& own = body.inertia;
    const Vector3 centre = moving.pose.position + rotation.lazyProduct(own.centre);
    OriginInertia& inertia = moving.inertia;
    inertia.mass = own.mass;
    inertia.first_moment = own.mass * centre;
    const Matrix3 half = rotation.lazyProduct(own.about_centre);
    inertia.about_origin.noalias() = half.lazyProduct(rotation.transpose());
    inertia.about_origin.noalias() -= inertia.first_moment.lazyProduct(centre.transpose());
    inertia.about_origin.diagonal().array() += inertia.first_moment.dot(centre);
    moving.momentum = inertia * moving.twist;
  }
}

Vector6 Dynamics::felt_gravity() const noexcept {
  // Gravity is as if everything accelerated the other way.
  Vector6 acceleration = Vector6::Zero();
  acceleration.tail<3>() = -(base_rotation_.transpose() * gravity_);
  return acceleration;
}

Result<> Dynamics::forward(const Coordinates& force, Coordinates& acceleration) noexcept {
  assert(force.size() == coordinate_count());
  if (model_->has_mimic()) return by_matrix_.forward(*this, force, acceleration);
  acceleration.resize(coordinate_count());
  const auto bodies = model_->bodies();
  for (Moving& moving : bodies_) {
    moving.articulated = moving.inertia.matrix();
    moving.articulated_force = cross_wrench(moving.twist, moving.momentum);
  }
  for (std::size_t i = bodies.size() - 1; i > 0; --i) {
    Moving& moving = bodies_[i];
    Moving& parent = bodies_[bodies[i].parent];
    moving.effective.noalias() = moving.articulated.lazyProduct(moving.axis);
    const double inertia = moving.axis.dot(moving.effective);
    if (!std::isfinite(inertia)) return fail(ErrorCode::OutOfRange, "an inertia is no number: positions are too large");
    if (!(inertia > no_inertia * moving.effective.norm() * moving.axis.norm()))
      return fail(ErrorCode::OutOfRange, "a joint moves nothing that has inertia", bodies[i].coordinate);
    moving.inverse_effective = 1 / inertia;
    moving.joint_force = force[first_joint_ + bodies[i].coordinate] - moving.axis.dot(moving.articulated_force);
    if (base_ == Base::Fixed && bodies[i].parent == 0) continue;
    const Vector6 scaled = moving.effective * moving.inverse_effective;
    parent.articulated_force +=
        moving.articulated_force + scaled * (moving.joint_force - moving.effective.dot(moving.drift));
    parent.articulated_force.noalias() += moving.articulated.lazyProduct(moving.drift);
    parent.articulated += moving.articulated;
    parent.articulated.noalias() -= scaled.lazyProduct(moving.effective.transpose());
  }
  Moving& root = bodies_[0];
  const Vector6 felt = felt_gravity();
  root.acceleration = felt;
  if (base_ == Base::Free) {
    const Eigen::LLT<Matrix6> factors{root.articulated};
    if (factors.info() != Eigen::Success)
      return fail(ErrorCode::OutOfRange, "the robot has no inertia against a motion of its base");
    root.acceleration = factors.solve(force.head<6>() - root.articulated_force);
    acceleration.head<6>() = root.acceleration - felt;
  }
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    Moving& moving = bodies_[i];
    moving.acceleration = bodies_[bodies[i].parent].acceleration + moving.drift;
    const double qdd = (moving.joint_force - moving.effective.dot(moving.acceleration)) * moving.inverse_effective;
    acceleration[first_joint_ + bodies[i].coordinate] = qdd;
    moving.acceleration += moving.axis * qdd;
  }
  return ok();
}

Result<> ByMassMatrix::forward(Dynamics& dynamics, const Coordinates& force, Coordinates& acceleration) noexcept {
  dynamics.mass_matrix(matrix_);
  dynamics.bias(bias_);
  factors_.compute(matrix_);
  if (factors_.info() != Eigen::Success) return fail(ErrorCode::OutOfRange, "the mass matrix is singular");
  acceleration = force - bias_;
  factors_.solveInPlace(acceleration);
  return ok();
}

void Dynamics::inverse(const Coordinates& acceleration, Coordinates& force) noexcept {
  assert(acceleration.size() == coordinate_count());
  Vector6 base = felt_gravity();
  if (base_ == Base::Free) base += acceleration.head<6>();
  forces(base, &acceleration, force);
}

void Dynamics::bias(Coordinates& force) noexcept { forces(felt_gravity(), nullptr, force); }

void Dynamics::forces(const Vector6& base_acceleration, const Coordinates* acceleration, Coordinates& force) noexcept {
  const auto bodies = model_->bodies();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Moving& moving = bodies_[i];
    moving.acceleration = i == 0 ? base_acceleration : Vector6{bodies_[bodies[i].parent].acceleration + moving.drift};
    if (i > 0 && acceleration != nullptr)
      moving.acceleration += moving.axis * (*acceleration)[first_joint_ + bodies[i].coordinate];
    moving.force = moving.inertia * moving.acceleration + cross_wrench(moving.twist, moving.momentum);
  }
  force.setZero(coordinate_count());
  for (std::size_t i = bodies.size() - 1; i > 0; --i) {
    const Moving& moving = bodies_[i];
    force[first_joint_ + bodies[i].coordinate] += moving.axis.dot(moving.force);
    bodies_[bodies[i].parent].force += moving.force;
  }
  if (base_ == Base::Free) force.head<6>() = bodies_[0].force;
}

void Dynamics::compose() noexcept {
  for (Moving& moving : bodies_) moving.composite = moving.inertia;
  for (std::size_t i = bodies_.size() - 1; i > 0; --i)
    bodies_[model_->bodies()[i].parent].composite += bodies_[i].composite;
}

void Dynamics::mass_matrix(MassMatrix& matrix) noexcept {
  const auto bodies = model_->bodies();
  compose();
  matrix.setZero(coordinate_count(), coordinate_count());
  if (base_ == Base::Free) {
    matrix.topLeftCorner<6, 6>() = bodies_[0].composite.matrix();
    // Rounding must not make its halves differ.
    const Matrix3 about = matrix.topLeftCorner<3, 3>();
    matrix.topLeftCorner<3, 3>() = (about + about.transpose()) / 2;
  }
  for (std::size_t i = bodies.size() - 1; i > 0; --i) {
    const int own = first_joint_ + bodies[i].coordinate;
    const Vector6 momentum = bodies_[i].composite * bodies_[i].axis;
    matrix(own, own) += bodies_[i].axis.dot(momentum);
    for (std::size_t above = bodies[i].parent; above > 0; above = bodies[above].parent) {
      const int other = first_joint_ + bodies[above].coordinate;
      const double shared = bodies_[above].axis.dot(momentum);
      matrix(own, other) += shared;
      matrix(other, own) += shared;
    }
    if (base_ == Base::Fixed) continue;
    matrix.block<6, 1>(0, own) += momentum;
    matrix.block<1, 6>(own, 0) += momentum.transpose();
  }
}

Pose Dynamics::frame_pose(FrameId frame) const noexcept {
  const Model::Frame& its = model_->frame(frame);
  return Pose{base_rotation_, base_position_} * (bodies_[its.body].pose * its.placement);
}

Vector6 Dynamics::frame_twist(FrameId frame) const noexcept {
  const Model::Frame& its = model_->frame(frame);
  const Moving& moving = bodies_[its.body];
  return rotated(base_rotation_, at_point(moving.twist, moving.pose * its.placement.position));
}

void Dynamics::jacobian(FrameId frame, Jacobian& jacobian) const noexcept {
  const auto bodies = model_->bodies();
  const Model::Frame& its = model_->frame(frame);
  const Vector3 point = bodies_[its.body].pose * its.placement.position;
  jacobian.setZero(6, coordinate_count());
  if (base_ == Base::Free) {
    jacobian.topLeftCorner<3, 3>() = base_rotation_;
    jacobian.block<3, 3>(3, 0) = -base_rotation_ * cross_matrix(point);
    jacobian.block<3, 3>(3, 3) = base_rotation_;
  }
  for (std::size_t i = its.body; i > 0; i = bodies[i].parent)
    jacobian.col(first_joint_ + bodies[i].coordinate) += rotated(base_rotation_, at_point(bodies_[i].axis, point));
}

Vector6 Dynamics::frame_drift(FrameId frame) const noexcept {
  const auto bodies = model_->bodies();
  const Model::Frame& its = model_->frame(frame);
  const Vector3 point = bodies_[its.body].pose * its.placement.position;
  Vector6 drift = Vector6::Zero();
  for (std::size_t i = its.body; i > 0; i = bodies[i].parent) drift += bodies_[i].drift;
  const Vector6 twist = at_point(bodies_[its.body].twist, point);
  drift = at_point(drift, point);
  drift.tail<3>() += twist.head<3>().cross(twist.tail<3>());
  return rotated(base_rotation_, drift);
}

Result<> Dynamics::generalised_jacobian(FrameId frame, Jacobian& jacobian) noexcept {
  this->jacobian(frame, jacobian);
  if (base_ == Base::Fixed) return ok();
  const auto bodies = model_->bodies();
  compose();
  const Eigen::LLT<Matrix6> factors{bodies_[0].composite.matrix()};
  if (factors.info() != Eigen::Success)
    return fail(ErrorCode::OutOfRange, "the robot has no inertia against a rotation");
  // What each joint does to the momentum the base takes up.
  const Matrix6 of_base = jacobian.leftCols<6>();
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const Vector6 momentum = bodies_[i].composite * bodies_[i].axis;
    jacobian.col(first_joint_ + bodies[i].coordinate) -= of_base * factors.solve(momentum);
  }
  for (int i = 0; i < model_->joint_count(); ++i) jacobian.col(i) = jacobian.col(first_joint_ + i).eval();
  jacobian.conservativeResize(6, model_->joint_count());
  return ok();
}

Vector3 Dynamics::centre_of_mass() const noexcept {
  Vector3 moment = Vector3::Zero();
  for (const Moving& moving : bodies_) moment += moving.inertia.first_moment;
  if (model_->mass() > 0) moment /= model_->mass();
  return base_position_ + base_rotation_ * moment;
}

Momentum Dynamics::momentum() const noexcept {
  Vector6 sum = Vector6::Zero();
  Vector3 moment = Vector3::Zero();
  for (const Moving& moving : bodies_) {
    sum += moving.momentum;
    moment += moving.inertia.first_moment;
  }
  if (model_->mass() > 0) moment /= model_->mass();
  return {base_rotation_ * sum.tail<3>(), base_rotation_ * (sum.head<3>() - moment.cross(sum.tail<3>()))};
}

double Dynamics::kinetic_energy() const noexcept {
  double twice = 0;
  for (const Moving& moving : bodies_) twice += moving.twist.dot(moving.momentum);
  return twice / 2;
}

double Dynamics::potential_energy() const noexcept { return -model_->mass() * gravity_.dot(centre_of_mass()); }

}  // namespace hirosco::robotics
