// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_laws.hpp"

#include <algorithm>
#include <cmath>

#include "robotics/motion/sampled_rates.hpp"

namespace hirosco::robot_arm {

void FloatingLaws::begin(Eigen::Index joints, double cycle_s) noexcept {
  soft_.begin(joints);
  change_.begin(joints, cycle_s);
  kind_ = LawKind::Position;
  aims_.let_go();
  expected_.setZero(joints);
  torque_ = expected_;
  cycle_s_ = cycle_s;
  fastest_rad_s_ = robotics::fastest_rad_s(cycle_s);
  fastest_swing_ = std::min(followed_per_s, fastest_rad_s_);
}

/// Who is let go of, or was pushed by torques, is so at once; all else comes slower.
void FloatingLaws::take(LawKind kind) noexcept {
  if (kind == kind_) return;
  const bool led =
      kind == LawKind::Float || kind == LawKind::Torque || kind_ == LawKind::Float || kind_ == LawKind::Torque;
  change_.change(led ? LawChange::let_go_s : LawChange::smooth_s);
  aims_.let_go();
  kind_ = kind;
}

/// Of the law of velocities all is an answer; what of it accelerates an arm that nobody meets, presses on nobody. Of that the law itself is the model: joints that follow as it says.
JointVector FloatingLaws::moved_by_model(const FloatingModel& model, const Now& now) noexcept {
  const JointVector off = now.followed_per_s * (now.rates - expected_);
  expected_ += std::min(1.0, cycle_s_ * now.followed_per_s) * (now.rates - expected_);
  JointVector torque = JointVector::Zero(off.size());
  for (Eigen::Index i = 0; i < off.size(); ++i) torque[i] = model.inertia().row(i).dot(off);
  return torque;
}

/// Not yet within anything but efforts. `carrying`: what of it presses on nobody.
JointVector FloatingLaws::asked(const FloatingModel& model, const Measured& measured, Bounds bounds, const Now& now,
                                JointVector& carrying) noexcept {
  if (now.kind == LawKind::Position) {
    carrying = moved_by_model(model, now);
    return joint_torque(model, now.rates, measured.velocity, bounds, now.followed_per_s);
  }
  expected_ = measured.velocity;
  aims_.remember(measured.position);
  const bool by_setpoint = now.kind == LawKind::JointImpedance;
  const auto aim = [&](Eigen::Index i) {
    return by_setpoint ? Aim{now.goal.joints.position[i], now.goal.joints.position[i]} : aims_.of(i);
  };
  carrying = wall_torque(model, measured, aim, bounds, fastest_rad_s_);
  switch (now.kind) {
    case LawKind::Position: break;
    case LawKind::JointImpedance:
    case LawKind::ToolImpedance: {
      const double strongest = robotics::strongest_damper_per_s(fastest_swing_) / model.heavier();
      return carrying + soft_.torque(now.kind, now.axes, model, measured, now.goal, bounds, strongest);
    }
    case LawKind::Float:
      return float_torque(model, measured, carrying, bounds, std::min(now.float_damping_per_s, now.followed_per_s));
    case LawKind::Torque: carrying += now.driven.brake; return carrying + now.driven.torque;
  }
  return carrying;
}

const JointVector& FloatingLaws::torque(const FloatingModel& model, const Measured& measured, Bounds bounds,
                                        const Now& now) noexcept {
  take(now.kind);
  JointVector carrying;
  torque_ = change_.without_a_step(asked(model, measured, bounds, now, carrying));
  if (now.lever != nullptr)
    torque_ =
        within_work(torque_, {carrying, JointVector::Zero(torque_.size())}, measured.velocity, *now.lever, now.work);
  for (Eigen::Index i = 0; i < torque_.size(); ++i) {
    const double effort = bounds[static_cast<std::size_t>(i)].effort;
    torque_[i] = std::isfinite(torque_[i]) ? std::clamp(torque_[i], -effort, effort) : 0;
  }
  change_.put_out(torque_);
  return torque_;
}

}  // namespace hirosco::robot_arm
