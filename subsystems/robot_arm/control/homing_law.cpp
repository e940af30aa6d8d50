// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/homing_law.hpp"

#include <algorithm>

#include "subsystems/robot_arm/control/law.hpp"

namespace hirosco::robot_arm {
namespace {

/// Of the integral against the spring: stable while a joint moves no more than 6 w / 1 s times its rotor, 240 times with 40 rad/s.
constexpr double learns_per_s = 0.5;
constexpr double presses_after_s = 0.02;
constexpr double no_speed = 1e-6;

}  // namespace

HomingLaw::HomingLaw(const robotics::Model& model, double cycle_s) : model_{&model}, cycle_s_{cycle_s} { begin(); }

void HomingLaw::begin() noexcept {
  integral_.setZero(model_->joint_count());
  pressed_cycles_ = {};
  at_bound_ = {};
}

/// Towards a bound that it has reached nothing is learnt, nor from what dry friction leaves of a joint that rests.
void HomingLaw::learn(Eigen::Index joint, double error, const Setpoint& wanted, const Measured& measured,
                      double steepness, double most) noexcept {
  if (!std::isfinite(error) || error * at_bound_[static_cast<std::size_t>(joint)] > 0) return;
  const bool rests = std::abs(wanted.velocity[joint]) < no_speed;
  if (rests && std::abs(error) < left_alone && std::abs(measured.velocity[joint]) < friction_knee) return;
  const double most_learnt = most / steepness;
  integral_[joint] = std::clamp(integral_[joint] + error * cycle_s_, -most_learnt, most_learnt);
}

JointVector HomingLaw::torque(const Setpoint& wanted, const Measured& measured, const Settings& settings) noexcept {
  const double w = settings.bandwidth_rad_s;
  JointVector torque = JointVector::Zero(integral_.size());
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    if (joint >= settings.rotor.size() || joint >= settings.most.size()) continue;
    const double rotor = settings.rotor[joint], most = settings.most[joint];
    const double spring = 3 * w * w * rotor, damper = 3 * w * rotor, steepness = learns_per_s * spring;
    const double error = wanted.position[i] - measured.position[i], speed = wanted.velocity[i];
    if (steepness > 0) learn(i, error, wanted, measured, steepness, most);
    const auto& its = model_->joints()[joint];
    double value = rotor * wanted.acceleration[i] + damper * (speed - measured.velocity[i]) + spring * error +
                   steepness * integral_[i] + its.damping * speed + its.friction * std::tanh(speed / friction_knee);
    if (!std::isfinite(value)) value = 0;
    torque[i] = std::clamp(value, -most, most);
    at_bound_[joint] = static_cast<std::int8_t>(torque[i] == value ? 0 : value > 0 ? 1 : -1);
    const bool presses = at_bound_[joint] != 0 || std::abs(measured.torque[i]) > most;
    pressed_cycles_[joint] = presses ? pressed_cycles_[joint] + 1 : 0;
  }
  return torque;
}

std::optional<std::size_t> HomingLaw::presses() const noexcept {
  for (std::size_t joint = 0; joint < pressed_cycles_.size(); ++joint)
    if (pressed_cycles_[joint] * cycle_s_ > presses_after_s - cycle_s_ / 2) return joint;
  return std::nullopt;
}

}  // namespace hirosco::robot_arm
