// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/drives.hpp"

namespace hirosco::robot_arm {

void Drives::forget(std::size_t joints) noexcept {
  measured_.position = measured_.velocity = measured_.torque = JointVector::Zero(static_cast<Eigen::Index>(joints));
}

void Drives::measure(State state) noexcept {
  const ArmInput in = says();
  current_.store({static_cast<std::int32_t>(state), in.position, in.velocity, in.torque, port().flags()});
  measured_ = {vector_of(in.position), vector_of(in.velocity), vector_of(in.torque)};
}

ArmInput Drives::says() const noexcept {
  if (!tells_force_) return port_.input();
  const SensingArmInput& in = sensing_port_.input();
  return {in.position, in.velocity, in.torque};
}

TipForce Drives::force() const noexcept {
  const SensingArmInput& in = sensing_port_.input();
  return {in.force_n, in.moment_n_m, in.age_ms};
}

}  // namespace hirosco::robot_arm
