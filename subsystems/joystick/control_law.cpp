// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/joystick/control_law.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::joystick {

void DisplayLaw::take_over(const DisplayLaw& other) noexcept {
  state_ = {.held_n_m = other.state_.held_n_m, .share = other.state_.share};
}

Axes DisplayLaw::torque(const Input& input, double force_scale) noexcept {
  state_.clipped = false;
  state_.acted = false;
  if (input.peer_active) {
    // At once up: the robot's own torque starts without a jump, and a ramp here would only be lag.
    state_.share = ramp_cycles;
    for (std::size_t i = 0; i < state_.held_n_m.size(); ++i)
      state_.held_n_m[i] = -force_scale * input.peer_torque_n_m[i];
  } else {
    state_.share = std::max(state_.share - 1, 0);
  }
  Axes torque{};
  for (std::size_t i = 0; i < torque.size(); ++i) {
    double wanted = state_.held_n_m[i] * state_.share / ramp_cycles;
    if (state_.share > 0) wanted = observed(i, wanted, input.velocity_rad_s[i]);
    if (!std::isfinite(wanted)) wanted = 0;
    torque[i] = std::clamp(wanted, -torque_max_n_m, torque_max_n_m);
    state_.clipped = state_.clipped || torque[i] != wanted;
  }
  return torque;
}

double DisplayLaw::observed(std::size_t axis, double torque_n_m, double velocity_rad_s) noexcept {
  if (!std::isfinite(torque_n_m * velocity_rad_s)) return 0;  // a damaged sample must not end the observer's count
  double& energy = state_.energy_j[axis];
  energy -= torque_n_m * velocity_rad_s * period_s_;
  const double added = damping(energy, velocity_rad_s);
  if (added <= 0) return torque_n_m;
  const double taken_out = added * velocity_rad_s * velocity_rad_s * period_s_;
  energy += taken_out;
  state_.dissipated_j += taken_out;
  state_.acted = true;
  return torque_n_m - added * velocity_rad_s;
}

double PassivePositionForce::damping(double energy_j, double velocity_rad_s) const noexcept {
  constexpr double smallest_rate_rad_s = 1e-3;
  constexpr double largest_damping_n_m_s = 1.0;
  if (energy_j >= 0 || std::abs(velocity_rad_s) < smallest_rate_rad_s) return 0;
  return std::min(-energy_j / (velocity_rad_s * velocity_rad_s * period_s()), largest_damping_n_m_s);
}

}  // namespace hirosco::joystick
