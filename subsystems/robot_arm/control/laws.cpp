// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/laws.hpp"

#include <algorithm>

namespace hirosco::robot_arm {
namespace {

/// So slowly an answer to errors is taken for that to a load: a push of a contact is over before, or has been told.
constexpr double load_s = 1;
/// At most so much is, of a joint's effort.
constexpr double load_share = 0.3;

}  // namespace

Laws::Laws(const robotics::Model& model, robotics::FrameId tip, double cycle_s)
    : law_{model, tip, cycle_s}, compliance_{model, tip}, cycle_s_{cycle_s} {
  last_.setZero(model.joint_count());
  reset();
}

void Laws::reset() noexcept {
  kind_ = LawKind::Position;
  law_.reset();
  carried_.setZero(last_.size());
  kept_ = carried_;
  fading_s_ = 0;
  changed_ = put_out_ = false;
}

void Laws::set(LawKind kind, double over_s) noexcept {
  if (kind == LawKind::Position && kind_ != kind) law_.reset();
  if (kind == LawKind::Float && kind_ != kind) compliance_.let_go();
  kind_ = kind;
  fade_s_ = over_s;
  changed_ = true;
}

void Laws::set(LawKind kind, const Impedance& impedance) noexcept {
  compliance_.set(impedance);
  set(kind);
}

void Laws::set_tool(const Vector3& place_m) noexcept {
  compliance_.set_tool(place_m);
  fade_s_ = smooth_s;
  changed_ = true;
}

void Laws::take_load(const JointVector& torque, const Settings& settings) noexcept {
  law_.let_go_of(torque, settings.position);
  carried_ -= learnt_of(carried_, torque);
  fade_s_ = smooth_s;
  changed_ = true;
}

void Laws::carry(const JointVector& answer, Bounds bounds) noexcept {
  if (!answer.allFinite()) return;
  for (Eigen::Index i = 0; i < answer.size(); ++i) {
    const double most = load_share * bounds[static_cast<std::size_t>(i)].effort;
    carried_[i] = std::clamp(carried_[i] + (answer[i] - carried_[i]) * (cycle_s_ / load_s), -most, most);
  }
}

JointVector Laws::torque(const Setpoint& wanted, const Measured& measured, robotics::Dynamics& dynamics,
                         const Payload& payload, Bounds bounds, const Settings& settings) noexcept {
  JointVector torque, carrying, answer, learnt;
  if (kind_ == LawKind::Position) {
    learnt.setZero(carried_.size());  // the integral's is an answer
    torque = law_.torque(wanted, measured, dynamics, payload, bounds, settings.position);
    answer = law_.answer(settings.position);
    carrying = law_.unbounded() - answer;
  } else {
    torque = compliance_.torque(wanted, measured, dynamics, payload, bounds,
                                {.kind = kind_,
                                 .float_damping_per_s = settings.float_damping_per_s,
                                 .rotor = settings.position.rotor,
                                 .gravity_m_s2 = settings.position.gravity_m_s2,
                                 .fastest_rad_s = robotics::fastest_rad_s(cycle_s_)}) +
             carried_;
    carrying = compliance_.carrying();
    learnt = carried_;
  }
  if (changed_) {
    changed_ = false;
    fading_s_ = put_out_ ? fade_s_ : 0;
    kept_ = last_ - torque;
    if (!kept_.allFinite()) kept_.setZero();
  } else {
    fading_s_ = std::max(0.0, fading_s_ - cycle_s_);
  }
  if (fading_s_ > 0)
    for (Eigen::Index i = 0; i < torque.size(); ++i) torque[i] += fading_s_ / fade_s_ * kept_[i];
  if (settings.lever != nullptr) {
    const JointVector within =
        within_work(torque, {carrying, learnt}, measured.velocity, *settings.lever, settings.work);
    if (within != torque) {
      law_.hold_back();
      answer = within - carrying;  // what was held back was no answer to a load
    }
    torque = within;
  }
  if (kind_ == LawKind::Position) carry(answer, bounds);
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    double value = torque[i];
    if (!std::isfinite(value)) value = 0;
    const double effort = bounds[static_cast<std::size_t>(i)].effort;
    last_[i] = std::clamp(value, -effort, effort);
  }
  put_out_ = true;
  return last_;
}

}  // namespace hirosco::robot_arm
