// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/setpoint_governor.hpp"

namespace hirosco::manipulator {

void SetpointGovernor::reset(const Joints& setpoint_rad) noexcept {
  asked_ = setpoint_ = setpoint_rad;
  speed_ = Joints::zeros(setpoint_rad.size());
}

Joints SetpointGovernor::advance(const Joints& asked_rad, const Joints& motor_rad, const Bounds& bounds,
                                 double span_s) noexcept {
  const MotionLimits& limits = bounds.motion;
  const Joints from = setpoint_;
  for (std::size_t i = 0; i < setpoint_.size(); ++i) {
    const double asked = std::isfinite(asked_rad[i]) ? asked_rad[i] : asked_[i];
    const double asked_speed = (asked - asked_[i]) / span_s;
    const double behind = asked_[i] - setpoint_[i];
    // As fast beyond what is asked for as can be braked away on the way that is left.
    const double surplus = std::sqrt(2 * limits.acceleration_rad_s2 * std::abs(behind));
    double speed = asked_speed + std::clamp(behind / span_s, -surplus, surplus);
    speed = std::clamp(speed, -limits.speed_rad_s, limits.speed_rad_s);
    speed = towards(speed_[i], speed, limits.acceleration_rad_s2 * span_s);
    const double next = setpoint_[i] + speed * span_s;
    const double near = motor_rad[i] + std::clamp(next - motor_rad[i], -bounds.lead_rad, bounds.lead_rad);
    setpoint_[i] = near;
    asked_[i] = asked;
  }
  if (surface_ != nullptr) slow_down_before_the_surface(from, bounds, span_s);
  Joints given = setpoint_;
  for (std::size_t i = 0; i < setpoint_.size(); ++i) {
    speed_[i] = std::clamp((setpoint_[i] - from[i]) / span_s, -limits.speed_rad_s, limits.speed_rad_s);
    given[i] = towards(setpoint_[i], asked_[i], grain_rad);
  }
  return given;
}

void SetpointGovernor::slow_down_before_the_surface(const Joints& from_rad, const Bounds& bounds,
                                                    double span_s) noexcept {
  const double before_m = surface_->gap_m(from_rad);
  const double closing_m = before_m - surface_->gap_m(setpoint_);
  const double most_m = (bounds.contact_speed_m_s + bounds.approach_per_s * std::max(before_m, 0.0)) * span_s;
  if (!(closing_m > most_m)) return;
  const double share = most_m / closing_m;
  for (std::size_t i = 0; i < setpoint_.size(); ++i) setpoint_[i] = from_rad[i] + share * (setpoint_[i] - from_rad[i]);
}

SetpointGovernor::Bounds bounds_for(double effort_n_m, double kp_n_m_per_rad) noexcept {
  constexpr double effort_of_default_n_m = 15;
  constexpr double contact_speed_m_s = 0.060;
  const double share = effort_n_m / effort_of_default_n_m;
  const MotionLimits at_default{};
  return {.motion = {at_default.speed_rad_s * share, at_default.acceleration_rad_s2 * share},
          .lead_rad = effort_n_m / kp_n_m_per_rad,
          .contact_speed_m_s = contact_speed_m_s * share};
}

}  // namespace hirosco::manipulator
