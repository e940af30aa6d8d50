// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/joystick/joystick_handle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hirosco::simulation {
namespace {

/// Minimum jerk from 0 to 1 and its rate, s in 0..1.
double minimum_jerk(double s) noexcept { return s * s * s * (10 + s * (6 * s - 15)); }
double minimum_jerk_rate(double s) noexcept { return 30 * s * s * (1 - s) * (1 - s); }

}  // namespace

void OperatorHand::begin(Mode mode, const Vec2& target_rad, double span_s) noexcept {
  from_rad_ = intent().angle_rad;
  target_rad_ = target_rad;
  started_s_ = time_s_;
  span_s_ = span_s;
  mode_ = mode;
}

void OperatorHand::hold(const Vec2& angle_rad) noexcept { begin(Mode::Hold, angle_rad, 0); }

void OperatorHand::sine(std::size_t axis, double amplitude_rad, double frequency_hz, double phase_rad) noexcept {
  if (mode_ != Mode::Sine) {
    begin(Mode::Sine, intent().angle_rad, 0);
    for (std::size_t i = 0; i < 2; ++i) sines_[i] = {.offset_rad = from_rad_[i]};
  }
  sines_[axis & 1] = {amplitude_rad, frequency_hz, phase_rad, time_s_, 0};
}

void OperatorHand::ramp(const Vec2& offset_m, double speed_m_s) noexcept {
  const Vec2 way = offset_m - times(jacobian_, intent().angle_rad);
  begin(Mode::Ramp, solve(jacobian_, offset_m), speed_m_s > 0 ? magnitude(way) / speed_m_s : 0);
}

void OperatorHand::cartesian(const Vec2& offset_m, double span_s) noexcept {
  begin(Mode::Cartesian, solve(jacobian_, offset_m), span_s);
}

void OperatorHand::follow(const Vec2& angle_rad) noexcept {
  constexpr double between_commands_s = 0.02;
  constexpr double fastest_rad_s = 0.6;  // of a careful hand: a command of a page may be a jump
  const Vec2 way = angle_rad - intent().angle_rad;
  const double farther_rad = std::max(std::abs(way[0]), std::abs(way[1]));
  begin(Mode::Ramp, angle_rad, std::max(between_commands_s, farther_rad / fastest_rad_s));
}

void OperatorHand::wander() noexcept {
  begin(Mode::Wander, intent().angle_rad, 0);
  next_wish();
}

void OperatorHand::next_wish() noexcept {
  // Home is 12.55 mm from the rail: one wish in four goes 1 to 6 mm into it and stays there for a while.
  const bool touch = random_.uniform() < 0.25;
  const Vec2 offset_m{touch ? random_.uniform(0.0135, 0.0185) : random_.uniform(-0.015, 0.008),
                      random_.uniform(-0.012, 0.012)};
  begin(Mode::Wander, solve(jacobian_, offset_m), random_.uniform(1.5, 3.5));
}

void OperatorHand::custom(std::function<Intent(double)> intent) {
  begin(Mode::Custom, target_rad_, 0);
  custom_ = std::move(intent);
}

void OperatorHand::advance(double span_s) noexcept {
  time_s_ += span_s;
  constexpr double rest_s = 0.5;
  if (mode_ == Mode::Wander && time_s_ - started_s_ > span_s_ + rest_s) next_wish();
}

Intent OperatorHand::path(bool smooth) const noexcept {
  const double past_s = time_s_ - started_s_;
  if (past_s >= span_s_) return {target_rad_, {}};
  const double s = past_s / span_s_;
  const Vec2 way = target_rad_ - from_rad_;
  if (smooth) return {from_rad_ + minimum_jerk(s) * way, minimum_jerk_rate(s) / span_s_ * way};
  return {from_rad_ + s * way, 1 / span_s_ * way};
}

Intent OperatorHand::intent() const noexcept {
  switch (mode_) {
    case Mode::Hold: return {target_rad_, {}};
    case Mode::Ramp: return path(false);
    case Mode::Cartesian:
    case Mode::Wander: return path(true);
    case Mode::Custom: return custom_(time_s_ - started_s_);
    case Mode::Sine: break;
  }
  Intent wish;
  for (std::size_t i = 0; i < 2; ++i) {
    const double omega = 2 * std::numbers::pi * sines_[i].frequency_hz;
    const double angle = omega * (time_s_ - sines_[i].started_s) + sines_[i].phase_rad;
    wish.angle_rad[i] = sines_[i].offset_rad + sines_[i].amplitude_rad * std::sin(angle);
    wish.rate_rad_s[i] = sines_[i].amplitude_rad * omega * std::cos(angle);
  }
  return wish;
}

double JoystickHandle::pull_n_m(double ahead_rad) const noexcept {
  const double most = parameters_.hand_pull_max_n_m;
  return std::clamp(parameters_.hand_stiffness_n_m_per_rad * ahead_rad, -most, most);
}

Vec2 JoystickHandle::hand_torque_n_m() const noexcept {
  if (!parameters_.hand_on) return {};
  const Intent wish = hand_.intent();
  const Vec2 ahead = wish.angle_rad - angle_rad_;
  return Vec2{pull_n_m(ahead[0]), pull_n_m(ahead[1])} +
         parameters_.hand_damping_n_m_s_per_rad * (wish.rate_rad_s - rate_rad_s_);
}

void JoystickHandle::step(const Vec2& torque_n_m, Duration span) noexcept {
  if (span <= Duration::zero()) return;
  const auto largest = parameters_.largest_sub_step;
  const auto sub_steps = (span + largest - Duration{1}) / largest;
  const double h = seconds(span) / static_cast<double>(sub_steps);
  const HandleParameters& p = parameters_;
  const double inertia = p.inertia_kg_m2 + (p.hand_on ? p.hand_inertia_kg_m2 : 0);
  const Vec2 motor{std::clamp(torque_n_m[0], -p.torque_max_n_m, p.torque_max_n_m),
                   std::clamp(torque_n_m[1], -p.torque_max_n_m, p.torque_max_n_m)};
  using Numbers = std::array<double, 4>;
  Numbers x{angle_rad_[0], angle_rad_[1], rate_rad_s_[0], rate_rad_s_[1]};
  for (std::int64_t step = 0; step < sub_steps; ++step) {
    const Intent wish = hand_.intent();
    x = runge_kutta_4(x, h, [&](const Numbers& at) {
      Numbers rate{at[2], at[3], 0, 0};
      for (std::size_t i = 0; i < 2; ++i) {
        // The wish stands still within a sub-step: 125 us against motions of seconds.
        double torque = motor[i] - p.friction_n_m_s * at[2 + i];
        if (p.hand_on)
          torque +=
              pull_n_m(wish.angle_rad[i] - at[i]) + p.hand_damping_n_m_s_per_rad * (wish.rate_rad_s[i] - at[2 + i]);
        const double beyond = at[i] - std::clamp(at[i], -p.range_rad, p.range_rad);
        if (beyond != 0) torque -= p.stop_n_m_per_rad * beyond + p.stop_n_m_s_per_rad * at[2 + i];
        rate[2 + i] = torque / inertia;
      }
      return rate;
    });
    hand_.advance(h);
  }
  angle_rad_ = {x[0], x[1]};
  rate_rad_s_ = {x[2], x[3]};
}

}  // namespace hirosco::simulation
