// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/momentum_observer.hpp"

namespace hirosco::robot_arm {

MomentumObserver::MomentumObserver(int joints, double cycle_s, double gain_per_s) noexcept
    : cycle_s_{cycle_s}, gain_per_s_{gain_per_s} {
  known_.setZero(joints);
  begun_.setZero(joints);
  external_.setZero(joints);
}

void MomentumObserver::reset() noexcept {
  started_ = false;
  known_.setZero();
  external_.setZero();
}

void MomentumObserver::update(const Measured& measured, robotics::Dynamics& dynamics,
                              const robotics::Coordinates& payload_torque) noexcept {
  robotics::MassMatrix mass;
  dynamics.mass_matrix(mass);
  robotics::Coordinates bias;
  dynamics.bias(bias);
  update(measured, mass, bias, payload_torque);
}

void MomentumObserver::update(const Measured& measured, const robotics::MassMatrix& mass,
                              const robotics::Coordinates& bias, const robotics::Coordinates& payload_torque) noexcept {
  JointVector momentum;
  momentum.noalias() = mass.lazyProduct(measured.velocity);
  if (!started_) {
    started_ = true;
    begun_ = momentum;
    mass_before_ = mass;
    return;
  }
  // d/dt (M qd) = dM/dt qd + M qdd, and M qdd = torque - bias + external.
  JointVector growth = measured.torque - bias - payload_torque;
  growth.noalias() += (mass - mass_before_).lazyProduct(measured.velocity) / cycle_s_;
  mass_before_ = mass;
  known_ += (growth + external_) * cycle_s_;
  external_ = gain_per_s_ * (momentum - begun_ - known_);
}

}  // namespace hirosco::robot_arm
