// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/joint_controller.hpp"

namespace hirosco::manipulator {
namespace {

constexpr double inertia_shaping = 4;      // motor inertia divided by this
constexpr double rate_filter = 0.2;        // share of the newest difference in qd', per cycle

}  // namespace

const Gains& GainRamp::advance(const Gains& wanted, double span_s) noexcept {
  now_.kp_n_m_per_rad = towards(now_.kp_n_m_per_rad, wanted.kp_n_m_per_rad, kp_rate_per_s * span_s);
  now_.kd_n_m_s_per_rad = towards(now_.kd_n_m_s_per_rad, wanted.kd_n_m_s_per_rad, kd_rate_per_s * span_s);
  now_.effort_max_n_m = wanted.effort_max_n_m;
  now_.surplus_max_n_m = wanted.surplus_max_n_m;
  return now_;
}

void JointController::reset(const Joints& desired_rad) noexcept {
  last_ = desired_rad;
  velocity_ = Joints::zeros(desired_rad.size());
}

Joints JointController::motor_torque(const Joints& desired_rad, const Measured& measured, const Gains& gains) noexcept {
  Joints torque = Joints::zeros(desired_rad.size());
  for (std::size_t i = 0; i < torque.size(); ++i) {
    const double difference = (desired_rad[i] - last_[i]) / period_s_;
    velocity_[i] += rate_filter * (difference - velocity_[i]);
    const double load = measured.torque_n_m[i];
    const double pull =
        std::clamp(gains.kp_n_m_per_rad * (desired_rad[i] - measured.motor_position_rad[i]),
                   std::min(load, 0.0) - gains.surplus_max_n_m, std::max(load, 0.0) + gains.surplus_max_n_m);
    const double damping = gains.kd_n_m_s_per_rad * (velocity_[i] - measured.motor_velocity_rad_s[i]);
    const double u = std::clamp(pull + damping, -gains.effort_max_n_m, gains.effort_max_n_m);
    const double wanted = inertia_shaping * u - (inertia_shaping - 1) * measured.torque_n_m[i];
    torque[i] = std::isfinite(wanted) ? std::clamp(wanted, -torque_max_n_m, torque_max_n_m) : 0;
  }
  last_ = desired_rad;
  return torque;
}

}  // namespace hirosco::manipulator
