// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/law.hpp"

#include <algorithm>

namespace hirosco::robot_arm {
namespace {

constexpr double at_rest = 1e-6;
/// An error this large is a collision or a jump and not the model's: nothing is learnt from it.
constexpr double not_learnt = 0.05;
/// Of what a joint's integral may give, what others' integrals and another posture may make of it.
constexpr double most_beyond = 1.5;

/// The integral's to learn, of a joint: at rest it has to overcome dry friction, too, of which nobody knows then which way it acts.
[[nodiscard]] double most_learnt(const Law::Settings& settings, const JointBounds& bounds, double friction) noexcept {
  return std::min(settings.integral_share * bounds.effort + friction, bounds.effort);
}

[[nodiscard]] double rotor_of(const Law::Settings& settings, Eigen::Index joint) noexcept {
  const auto i = static_cast<std::size_t>(joint);
  return i < settings.rotor.size() ? settings.rotor[i] : 0;
}

}  // namespace

JointVector learnt_of(const JointVector& learnt, const JointVector& torque) noexcept {
  JointVector part = torque;
  for (Eigen::Index i = 0; i < part.size(); ++i)
    part[i] = std::clamp(torque[i], std::min(0.0, learnt[i]), std::max(0.0, learnt[i]));
  return part;
}

Law::Law(const robotics::Model& model, robotics::FrameId tip, double cycle_s)
    : model_{&model}, tip_{tip}, cycle_s_{cycle_s} {
  reset();
}

void Law::reset() noexcept {
  integral_.setZero(model_->joint_count());
  saturated_ = false;
}

void Law::let_go_of(const JointVector& torque, const Settings& settings) noexcept {
  if (integral_.isZero(0) || !torque.allFinite()) return;  // nor is any mass known before
  const double w = settings.bandwidth_rad_s;
  robotics::MassMatrix moved = mass_;
  for (Eigen::Index i = 0; i < moved.rows(); ++i) moved(i, i) += rotor_of(settings, i);
  JointVector given;
  given.noalias() = moved.lazyProduct(integral_);
  JointVector part = learnt_of(w * w * w * given, torque);
  const Eigen::LLT<robotics::MassMatrix> factors{moved};
  factors.solveInPlace(part);
  if (part.allFinite()) integral_ -= part / (w * w * w);
}

void Law::learn(const JointVector& error, const Setpoint& wanted, const Measured& measured,
                robotics::Dynamics& dynamics, Bounds bounds, const Settings& settings) noexcept {
  const double w = settings.bandwidth_rad_s;
  dynamics.mass_matrix(mass_);
  // What it gives to each joint: of coupled ones each has to answer for what the others' does to it, so it is the torque that is bounded.
  JointVector given;
  given.noalias() = mass_.lazyProduct(integral_);
  const auto most_of = [&](Eigen::Index i) {
    const auto joint = static_cast<std::size_t>(i);
    return most_learnt(settings, bounds[joint], model_->joints()[joint].friction);
  };
  double within = 1;
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    given[i] = w * w * w * (given[i] + rotor_of(settings, i) * integral_[i]);
    const double most = most_of(i);
    if (std::abs(given[i]) > most_beyond * most) within = std::min(within, most_beyond * most / std::abs(given[i]));
  }
  integral_ *= within;
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    const bool rests = std::abs(wanted.velocity[i]) < at_rest;
    if (rests && std::abs(error[i]) < left_alone && std::abs(measured.velocity[i]) < friction_knee) continue;
    if (!(std::abs(error[i]) < not_learnt) || saturated_) continue;
    if (const double most = most_of(i); std::abs(given[i]) >= most && given[i] * error[i] > 0) continue;
    integral_[i] += error[i] * cycle_s_;
  }
}

JointVector Law::torque(const Setpoint& wanted, const Measured& measured, robotics::Dynamics& dynamics,
                        const Payload& payload, Bounds bounds, const Settings& settings) noexcept {
  const double w = settings.bandwidth_rad_s;
  const JointVector error = wanted.position - measured.position;
  learn(error, wanted, measured, dynamics, bounds, settings);
  answer_ = 3 * w * (wanted.velocity - measured.velocity) + 3 * w * w * error + w * w * w * integral_;
  robotics::Coordinates acceleration = wanted.acceleration + answer_;
  robotics::Coordinates force;
  dynamics.inverse(acceleration, force);
  add_payload(payload, tip_, settings.gravity_m_s2, dynamics, acceleration, force);
  const auto joints = model_->joints();
  JointVector torque;
  torque.resize(error.size());
  unbounded_.resize(error.size());
  saturated_ = false;
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    const auto& joint = joints[static_cast<std::size_t>(i)];
    const double speed = wanted.velocity[i];
    double value = force[i] + rotor_of(settings, i) * acceleration[i] + joint.damping * speed +
                   joint.friction * std::tanh(speed / friction_knee);
    if (!std::isfinite(value)) value = 0;
    const double effort = bounds[static_cast<std::size_t>(i)].effort;
    unbounded_[i] = value;
    torque[i] = std::clamp(value, -effort, effort);
    saturated_ = saturated_ || torque[i] != value;
  }
  return torque;
}

JointVector Law::answer(const Settings& settings) const noexcept {
  JointVector torque;
  torque.noalias() = mass_.lazyProduct(answer_);
  for (Eigen::Index i = 0; i < torque.size(); ++i) torque[i] += rotor_of(settings, i) * answer_[i];
  return torque;
}

void Law::add_payload(const Payload& payload, robotics::FrameId tip, const Vector3& gravity_m_s2,
                      const robotics::Dynamics& dynamics, const robotics::Coordinates& acceleration,
                      robotics::Coordinates& torque) noexcept {
  if (payload.mass_kg <= 0) return;
  Jacobian jacobian;
  dynamics.jacobian(tip, jacobian);
  const Vector3 arm = dynamics.frame_pose(tip).rotation * payload.place_m;
  const Vector6 drift = dynamics.frame_drift(tip);
  const Vector3 turning = dynamics.frame_twist(tip).head<3>();
  Vector6 rate = drift;
  rate.noalias() += jacobian.lazyProduct(acceleration);
  const Vector3 rotary = rate.head<3>();
  const Vector3 moved = rate.tail<3>() + rotary.cross(arm) + turning.cross(turning.cross(arm));
  const Vector3 force = payload.mass_kg * (moved - gravity_m_s2);
  Vector6 wrench;
  wrench.head<3>() = arm.cross(force);
  wrench.tail<3>() = force;
  torque.noalias() += jacobian.transpose().lazyProduct(wrench);
}

}  // namespace hirosco::robot_arm
