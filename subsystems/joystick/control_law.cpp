// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/joystick/control_law.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::joystick {

void ForceDisplay::reset() noexcept { *this = ForceDisplay{period_s_}; }

Axes ForceDisplay::torque(const Input& input, const Settings& settings) noexcept {
  clipped_ = false;
  acted_ = false;
  if (input.peer_active) {
    // At once up: the robot's own torque starts without a jump, and a ramp here would only be lag.
    share_ = ramp_cycles;
    for (std::size_t i = 0; i < held_n_m_.size(); ++i) held_n_m_[i] = -settings.force_scale * input.peer_torque_n_m[i];
  } else {
    share_ = std::max(share_ - 1, 0);
  }
  Axes torque{};
  for (std::size_t i = 0; i < torque.size(); ++i) {
    double wanted = held_n_m_[i] * share_ / ramp_cycles;
    if (settings.passivity && share_ > 0) wanted = made_passive(i, wanted, input.velocity_rad_s[i]);
    if (!std::isfinite(wanted)) wanted = 0;
    torque[i] = std::clamp(wanted, -torque_max_n_m, torque_max_n_m);
    clipped_ = clipped_ || torque[i] != wanted;
  }
  return torque;
}

double ForceDisplay::made_passive(std::size_t axis, double torque_n_m, double velocity_rad_s) noexcept {
  constexpr double smallest_rate_rad_s = 1e-3;
  constexpr double largest_damping_n_m_s = 1.0;
  if (!std::isfinite(torque_n_m * velocity_rad_s)) return 0;  // a damaged sample must not end the observer's count
  double& energy = energy_j_[axis];
  energy -= torque_n_m * velocity_rad_s * period_s_;
  if (energy >= 0 || std::abs(velocity_rad_s) < smallest_rate_rad_s) return torque_n_m;
  const double per_damping = velocity_rad_s * velocity_rad_s * period_s_;
  const double damping = std::min(-energy / per_damping, largest_damping_n_m_s);
  energy += damping * per_damping;
  dissipated_j_ += damping * per_damping;
  acted_ = true;
  return torque_n_m - damping * velocity_rad_s;
}

}  // namespace hirosco::joystick
