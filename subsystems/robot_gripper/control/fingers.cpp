// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/control/fingers.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_gripper {

Fingers::Fingers(std::span<const Finger> fingers, double full_width_m) noexcept
    : fingers_{Sized<Finger, max_fingers>::of(fingers)}, full_width_m_{full_width_m} {
  most_force_n_ = most_speed_m_s_ = HUGE_VAL;
  const auto all = static_cast<double>(count());
  for (std::size_t i = 0; i < count(); ++i) {
    const Finger& finger = fingers_[i];
    const double its = std::abs(way(i));
    most_force_n_ = std::min(most_force_n_, finger.effort * all * its);
    most_speed_m_s_ = std::min(most_speed_m_s_, finger.velocity / its);
    moved_kg_ += finger.moved * its * its;
    friction_n_ += finger.friction * its;
  }
}

double Fingers::width(const Joints& position) const noexcept {
  double open = 0;
  for (std::size_t i = 0; i < count(); ++i)
    open += (position[i] - fingers_[i].closed) / (fingers_[i].open - fingers_[i].closed);
  return full_width_m_ * open / static_cast<double>(count());
}

double Fingers::speed(const Joints& velocity) const noexcept {
  double speed = 0;
  for (std::size_t i = 0; i < count(); ++i) speed += velocity[i] / way(i);
  return speed / static_cast<double>(count());
}

double Fingers::force(const Joints& torque) const noexcept {
  double force = 0;
  for (std::size_t i = 0; i < count(); ++i) force -= torque[i] * way(i);
  return force;
}

Joints Fingers::torques(double closing_n, const Measured& measured, double bandwidth_rad_s) const noexcept {
  const double width_m = width(measured.position), speed_m_s = speed(measured.velocity);
  Joints torques = Joints::zeros(count());
  for (std::size_t i = 0; i < count(); ++i) {
    const Finger& finger = fingers_[i];
    double torque = -closing_n / (static_cast<double>(count()) * way(i));
    if (count() > 1) {
      const double off = finger.closed + way(i) * width_m - measured.position[i];
      const double off_per_s = way(i) * speed_m_s - measured.velocity[i];
      torque += finger.moved * bandwidth_rad_s * (bandwidth_rad_s * off + 2 * off_per_s);
    }
    torques[i] = std::isfinite(torque) ? std::clamp(torque, -finger.effort, finger.effort) : 0;
  }
  return torques;
}

}  // namespace hirosco::robot_gripper
