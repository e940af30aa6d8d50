// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control_law.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace hirosco::manipulator {
namespace {

constexpr double inertia_shaping = 4;      // motor inertia divided by this
constexpr double rate_filter = 0.2;        // share of the newest difference in qd', per cycle

/// Shifts a sample into the last three and tells whether two of them are set.
bool two_of_three(std::uint8_t& history, bool sample) noexcept {
  history = static_cast<std::uint8_t>((history << 1 | (sample ? 1 : 0)) & 0b111);
  return std::popcount(history) >= 2;
}

}  // namespace

void JointController::reset(const Joints& desired_rad) noexcept {
  last_ = desired_rad;
  velocity_ = {};
}

Joints JointController::motor_torque(const Joints& desired_rad, const Measured& measured, const Gains& gains) noexcept {
  Joints torque{};
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

void Trajectory::start(const Joints& from_rad, const Joints& to_rad, double duration_s) noexcept {
  from_ = from_rad;
  to_ = to_rad;
  duration_s_ = std::max(duration_s, 0.0);
  past_s_ = 0;
}

void Trajectory::stop() noexcept { start(position_rad(), position_rad(), 0); }

Joints Trajectory::advance(double span_s) noexcept {
  past_s_ = std::min(past_s_ + span_s, duration_s_);
  return position_rad();
}

double Trajectory::progress() const noexcept { return duration_s_ > 0 ? past_s_ / duration_s_ : 1; }

Joints Trajectory::position_rad() const noexcept {
  if (done()) return to_;  // exactly, not by way of the sum below
  const double s = progress();
  const double share = s * s * s * (10 + s * (6 * s - 15));
  return {from_[0] + share * (to_[0] - from_[0]), from_[1] + share * (to_[1] - from_[1])};
}

double Trajectory::peak_speed(const Joints& from_rad, const Joints& to_rad, double duration_s) noexcept {
  constexpr double peak = 1.875;  // of the minimum-jerk rate, at half time
  const double way = std::max(std::abs(to_rad[0] - from_rad[0]), std::abs(to_rad[1] - from_rad[1]));
  return peak * way / duration_s;
}

TorqueLimit::Finding TorqueLimit::update(const Joints& torque_n_m, double soft_n_m, double hard_n_m) noexcept {
  Finding worst;
  for (std::size_t i = 0; i < torque_n_m.size(); ++i) {
    const double size = std::abs(torque_n_m[i]);
    const bool soft = two_of_three(soft_[i], !(size <= soft_n_m));
    const bool hard = two_of_three(hard_[i], !(size <= hard_n_m));
    const auto verdict = hard ? TorqueVerdict::Hard : soft ? TorqueVerdict::Soft : TorqueVerdict::Fine;
    if (verdict > worst.verdict) worst = {verdict, static_cast<std::uint8_t>(i), torque_n_m[i]};
  }
  return worst;
}

Joints relieving(const Joints& motor_torque_n_m, const Joints& joint_torque_n_m, double limit_n_m) noexcept {
  Joints torque = motor_torque_n_m;
  for (std::size_t i = 0; i < torque.size(); ++i) {
    if (joint_torque_n_m[i] > limit_n_m) torque[i] = std::min(torque[i], limit_n_m);
    if (joint_torque_n_m[i] < -limit_n_m) torque[i] = std::max(torque[i], -limit_n_m);
  }
  return torque;
}

TemperatureVerdict judge(const std::array<float, 2>& temperature_c, const TemperatureLimits& limits) noexcept {
  TemperatureVerdict worst = TemperatureVerdict::Fine;
  for (const float celsius : temperature_c) {
    TemperatureVerdict verdict = TemperatureVerdict::Fine;
    if (!(celsius < limits.maximum_c)) verdict = TemperatureVerdict::Maximum;
    else if (celsius >= limits.critical_c) verdict = TemperatureVerdict::Critical;
    else if (celsius >= limits.warning_c) verdict = TemperatureVerdict::Warning;
    worst = std::max(worst, verdict);
  }
  return worst;
}

Joints tip(const Geometry& geometry, const Joints& position_rad) noexcept {
  const double both = position_rad[0] + position_rad[1];
  return {geometry.l1_m * std::cos(position_rad[0]) + geometry.l2_m * std::cos(both),
          geometry.l1_m * std::sin(position_rad[0]) + geometry.l2_m * std::sin(both)};
}

Joints joints_for(const Geometry& geometry, const Joints& tip_m) noexcept {
  const double l1 = geometry.l1_m;
  const double l2 = geometry.l2_m;
  const double square_m2 = tip_m[0] * tip_m[0] + tip_m[1] * tip_m[1];
  const double q2 = std::acos(std::clamp((square_m2 - l1 * l1 - l2 * l2) / (2 * l1 * l2), -1.0, 1.0));
  const double q1 = std::atan2(tip_m[1], tip_m[0]) - std::atan2(l2 * std::sin(q2), l1 + l2 * std::cos(q2));
  return {q1, q2};
}

Joints tip_force(const Geometry& geometry, const Joints& position_rad, const Joints& torque_n_m) noexcept {
  const double both = position_rad[0] + position_rad[1];
  const double x2 = geometry.l2_m * std::cos(both);
  const double y2 = geometry.l2_m * std::sin(both);
  const double x = geometry.l1_m * std::cos(position_rad[0]) + x2;
  const double y = geometry.l1_m * std::sin(position_rad[0]) + y2;
  const double det = x * y2 - y * x2;  // of J = [-y -y2; x x2]
  constexpr double smallest_det_m2 = 1e-3;
  if (!(std::abs(det) >= smallest_det_m2)) return {};
  return {(x2 * torque_n_m[0] - x * torque_n_m[1]) / det, (y2 * torque_n_m[0] - y * torque_n_m[1]) / det};
}

}  // namespace hirosco::manipulator
