// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/control/grip.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_gripper {
namespace {

/// Of the force that it is to press with: what tells that something was met.
constexpr double met_share = 0.3;
/// Who does not get on for so long has met something, whatever the sensors say.
constexpr double begun_s = 0.1, stall_s = 0.05, stalled_share = 0.2;
/// From what was felt on meeting something to the force that is wanted.
constexpr double build_up_s = 0.1;
/// Of what it should press with: less, while it closes, is nothing between the fingers.
constexpr double gone_share = 0.5, gone_m_s = 0.005;
constexpr double trim_per_s = 10, most_trim_share = 0.3;
constexpr double rest_m_s = 0.001;
constexpr double most_integral_share = 0.8;
constexpr double friction_from_m_s = 0.001;

}  // namespace

void Grip::keep() noexcept {
  law_ = Law::Width;
  integral_n_ = settled_s_ = leaves_n_ = 0;
}

void Grip::let_go() noexcept {
  const double pressed_n = law_ == Law::Press ? std::max(0.0, pressing_n_ + trim_n_) : 0;
  keep();
  leaves_n_ = leaving_n_ = pressed_n;
}

void Grip::grip(double force_n, double speed_m_s) noexcept {
  force_n_ = force_n;
  speed_m_s_ = speed_m_s;
  settled_s_ = 0;
  if (law_ == Law::Press) return;
  law_ = Law::Reach;
  integral_n_ = reaching_m_s_ = reached_s_ = stalled_s_ = leaves_n_ = 0;
  met_.forget();
  gone_.forget();
}

void Grip::press_on(double force_n, double speed_m_s) noexcept {
  law_ = Law::Press;
  force_n_ = pressing_n_ = force_n;
  speed_m_s_ = speed_m_s;
  trim_n_ = settled_s_ = 0;
  gone_.forget();
}

Joints Grip::torques(const Opening::Wanted& wanted, const Measured& measured) noexcept {
  const double width_m = fingers_.width(measured.position), speed_m_s = fingers_.speed(measured.velocity);
  const double force_n = fingers_.force(measured.torque);
  double closing_n = 0;
  switch (law_) {
    case Law::Width: closing_n = keep_width(wanted, width_m, speed_m_s) + leave(); break;
    case Law::Reach: closing_n = reach(speed_m_s, force_n); break;
    case Law::Press: closing_n = press(speed_m_s, force_n); break;
  }
  return fingers_.torques(closing_n, measured, settings_.bandwidth_rad_s);
}

/// What it pressed on is a spring: of whoever lets it go at once it throws the fingers open.
double Grip::leave() noexcept {
  leaves_n_ = std::max(0.0, leaves_n_ - leaving_n_ / build_up_s * settings_.cycle_s);
  return leaves_n_;
}

/// An error meets three poles at -bandwidth; the integral is for friction and for what pulls.
double Grip::keep_width(const Opening::Wanted& wanted, double width_m, double speed_m_s) noexcept {
  const double b = settings_.bandwidth_rad_s, mass = fingers_.moved_kg();
  const double off = wanted.width_m - width_m, off_per_s = wanted.speed_m_s - speed_m_s;
  const double most_n = settings_.width_force_n;
  const double friction_n = fingers_.friction_n() * std::tanh(wanted.speed_m_s / friction_from_m_s);
  const double opening_n =
      mass * (wanted.acceleration_m_s2 + 3 * b * off_per_s + 3 * b * b * off) + friction_n + integral_n_;
  if (std::abs(opening_n) < most_n)
    integral_n_ = std::clamp(integral_n_ + mass * b * b * b * off * settings_.cycle_s, -most_integral_share * most_n,
                             most_integral_share * most_n);
  return -std::clamp(opening_n, -most_n, most_n);
}

/// The speed of closing has two poles at -bandwidth, and no more force than it is to press with.
double Grip::reach(double speed_m_s, double force_n) noexcept {
  const double b = settings_.bandwidth_rad_s, mass = fingers_.moved_kg(), closing_m_s = -speed_m_s;
  reached_s_ += settings_.cycle_s;
  reaching_m_s_ = std::min(speed_m_s_, reaching_m_s_ + settings_.acceleration_m_s2 * settings_.cycle_s);
  const double slow_m_s = reaching_m_s_ - closing_m_s;
  integral_n_ = std::clamp(integral_n_ + mass * b * b * slow_m_s * settings_.cycle_s, -force_n_, force_n_);
  const double closing_n = std::clamp(2 * mass * b * slow_m_s + integral_n_, -force_n_, force_n_);
  const bool stands = reached_s_ > begun_s && closing_m_s < stalled_share * speed_m_s_;
  stalled_s_ = stands ? stalled_s_ + settings_.cycle_s : 0;
  if (met_.add(force_n >= met_share * force_n_) || stalled_s_ >= stall_s) {
    press_on(force_n_, speed_m_s_);
    pressing_n_ = std::clamp(closing_n, 0.0, force_n_);
  }
  return closing_n;
}

double Grip::press(double speed_m_s, double force_n) noexcept {
  const double b = settings_.bandwidth_rad_s, closing_m_s = -speed_m_s;
  const double step_n = std::max(force_n_, pressing_n_) / build_up_s * settings_.cycle_s;
  pressing_n_ += std::clamp(force_n_ - pressing_n_, -step_n, step_n);
  // Friction holds either way: twice what the file has, and a share for what it does not know.
  const double most_n = most_trim_share * force_n_ + 2 * fingers_.friction_n();
  trim_n_ = std::clamp(trim_n_ + trim_per_s * (pressing_n_ - force_n) * settings_.cycle_s, -most_n, most_n);
  const bool there = std::abs(force_n - force_n_) <= tolerance_ * force_n_ && std::abs(closing_m_s) < rest_m_s;
  settled_s_ = there ? settled_s_ + settings_.cycle_s : 0;
  const double closing_n = pressing_n_ + trim_n_ - 2 * fingers_.moved_kg() * b * closing_m_s;
  if (gone_.add(closing_m_s > gone_m_s && force_n < gone_share * pressing_n_)) {
    law_ = Law::Reach;
    reaching_m_s_ = std::min(closing_m_s, speed_m_s_);
    integral_n_ = reached_s_ = stalled_s_ = 0;
    met_.forget();
  }
  return std::clamp(closing_n, -force_n_ - most_n, force_n_ + most_n);
}

void Held::hold(double width_m) noexcept {
  held_ = true;
  width_m_ = width_m;
  closed_.forget();
  opened_.forget();
}

Held::Change Held::update(double width_m, double distance_m) noexcept {
  if (!held_) return Change::None;
  const bool closed = closed_.add(!(width_m >= width_m_ - distance_m));
  const bool opened = opened_.add(width_m > width_m_ + distance_m);
  if (!closed && !opened) return Change::None;
  held_ = false;
  return closed ? Change::LostClosed : Change::LostOpened;
}

}  // namespace hirosco::robot_gripper
