// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/setpoint.hpp"

namespace hirosco::manipulator {

void Setpoint::rest() noexcept {
  asked_ = parts_.drives.sensed().motor_position_rad;
  parts_.servo.rest(asked_);
  set_desired(asked_);
  governor_.reset(desired_rad());
}

void Setpoint::engage() noexcept {
  rest();
  trajectory_.start(asked_, asked_, 0.0);
}

void Setpoint::hold() noexcept {
  asked_ = desired_rad();
  trajectory_.start(asked_, asked_, 0.0);
}

void Setpoint::set_out(const Joints& target_rad, double duration_s) noexcept {
  trajectory_.start(desired_rad(), target_rad, duration_s);
}

void Setpoint::go_on(double span_s) noexcept {
  asked_ = trajectory_.advance(span_s);
  parts_.parameters.trajectory.store({trajectory_.target_rad(), trajectory_.duration_s(), trajectory_.progress()});
}

void Setpoint::govern(double span_s) noexcept {
  asked_ = parts_.joints.within_range(asked_);
  const auto bounds = bounds_for(parts_.parameters.torque_hard.load(), parts_.servo.gains().kp_n_m_per_rad);
  set_desired(governor_.advance(asked_, parts_.drives.sensed().motor_position_rad, bounds, span_s));
}

void Setpoint::set_desired(const Joints& position_rad) noexcept {
  parts_.parameters.desired_position.store(parts_.joints.within_range(position_rad));
}

}  // namespace hirosco::manipulator
