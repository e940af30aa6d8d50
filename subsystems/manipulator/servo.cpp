// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/servo.hpp"

namespace hirosco::manipulator {

void Servo::rest(const Joints& setpoint_rad) noexcept {
  controller_->reset(setpoint_rad);
  gains_.reset(wanted_gains());
}

bool Servo::advance_gains(double span_s) noexcept {
  const Gains wanted = wanted_gains();
  const Gains& gains = gains_.advance(wanted, span_s);
  parts_.parameters.gains.store({gains.kp_n_m_per_rad, gains.kd_n_m_s_per_rad});
  return gains_.reached(wanted);
}

void Servo::drive(const Joints& setpoint_rad) noexcept {
  put_out(setpoint_rad, parts_.drives.measured());
  parts_.parameters.desired_velocity.store(controller_->desired_velocity_rad_s());
}

Joints Servo::wish(const Joints& setpoint_rad, const Measured& measured) noexcept {
  controller_->reset(setpoint_rad);
  put_out(setpoint_rad, measured);
  return parts_.drives.puts_out();
}

void Servo::put_out(const Joints& setpoint_rad, const Measured& measured) noexcept {
  parts_.drives.put_out(law_(*controller_, setpoint_rad, measured, gains_.now()));
}

Gains Servo::wanted_gains() const noexcept {
  const double effort_n_m = parts_.parameters.torque_hard.load();
  return {parts_.parameters.kp.load(), parts_.parameters.kd.load(), effort_n_m, effort_n_m / 3};
}

}  // namespace hirosco::manipulator
