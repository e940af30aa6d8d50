// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/motion.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::manipulator {
namespace {

double towards(double now, double wanted, double step) noexcept { return now + std::clamp(wanted - now, -step, step); }

/// Of the finger from the contour with its bump as high as it may be; shortest distance to points 4 mm apart, so at most
/// 0.2 mm too long. Negative behind the surface.
double gap_to_contour(const Joints& tip_m) noexcept {
  const Surroundings around;
  constexpr int points_each_side = 6;
  constexpr double apart_m = 0.004;
  double nearest_m = HUGE_VAL;
  double across_m = 0;
  for (int k = -points_each_side; k <= points_each_side; ++k) {
    // The surface is where a finger would be that is pressed in by its own radius.
    const Joints surface = pressed_finger(around, tip_m[1] + k * apart_m, around.finger_radius_m);
    const double distance_m = std::hypot(surface[0] - tip_m[0], surface[1] - tip_m[1]);
    if (k == 0) across_m = surface[0] - tip_m[0];
    nearest_m = std::min(nearest_m, distance_m);
  }
  return (across_m < 0 ? -nearest_m : nearest_m) - around.finger_radius_m;
}

}  // namespace

double shortest_duration_s(const Joints& from_rad, const Joints& to_rad, const MotionLimits& limits) noexcept {
  // Of s^3 (10 - 15 s + 6 s^2): its largest rate, at half time, and its largest second derivative.
  constexpr double peak_rate = 1.875, peak_acceleration = 5.7735026918962576;
  const double way = std::max(std::abs(to_rad[0] - from_rad[0]), std::abs(to_rad[1] - from_rad[1]));
  return std::max(peak_rate * way / limits.speed_rad_s,
                  std::sqrt(peak_acceleration * way / limits.acceleration_rad_s2));
}

const Gains& GainRamp::advance(const Gains& wanted, double span_s) noexcept {
  now_.kp_n_m_per_rad = towards(now_.kp_n_m_per_rad, wanted.kp_n_m_per_rad, kp_rate_per_s * span_s);
  now_.kd_n_m_s_per_rad = towards(now_.kd_n_m_s_per_rad, wanted.kd_n_m_s_per_rad, kd_rate_per_s * span_s);
  now_.effort_max_n_m = wanted.effort_max_n_m;
  now_.surplus_max_n_m = wanted.surplus_max_n_m;
  return now_;
}

void SetpointGovernor::reset(const Joints& setpoint_rad) noexcept {
  asked_ = setpoint_ = setpoint_rad;
  speed_ = {};
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
  slow_down_before_the_contour(from, bounds, span_s);
  for (std::size_t i = 0; i < setpoint_.size(); ++i)
    speed_[i] = std::clamp((setpoint_[i] - from[i]) / span_s, -limits.speed_rad_s, limits.speed_rad_s);
  return {towards(setpoint_[0], asked_[0], grain_rad), towards(setpoint_[1], asked_[1], grain_rad)};
}

void SetpointGovernor::slow_down_before_the_contour(const Joints& from_rad, const Bounds& bounds,
                                                    double span_s) noexcept {
  const double before_m = gap_to_contour(tip(geometry_, from_rad));
  const double closing_m = before_m - gap_to_contour(tip(geometry_, setpoint_));
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

Arrival::Verdict Arrival::judge(const Joints& measured_rad, const Joints& goal_rad, double tolerance_rad,
                                double span_s) noexcept {
  error_rad_ = std::max(std::abs(measured_rad[0] - goal_rad[0]), std::abs(measured_rad[1] - goal_rad[1]));
  if (error_rad_ <= tolerance_rad) return Verdict::There;
  waited_s_ += span_s;
  return waited_s_ < patience_s ? Verdict::UnderWay : Verdict::Missed;
}

}  // namespace hirosco::manipulator
