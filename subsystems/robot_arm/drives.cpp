// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/drives.hpp"

namespace hirosco::robot_arm {

void Drives::forget(std::size_t joints) noexcept {
  measured_.position = measured_.velocity = measured_.torque = JointVector::Zero(static_cast<Eigen::Index>(joints));
}

void Drives::measure(State state) noexcept {
  const ArmInput& in = port_.input();
  current_.store({static_cast<std::int32_t>(state), in.position, in.velocity, in.torque, port_.flags()});
  measured_ = {vector_of(in.position), vector_of(in.velocity), vector_of(in.torque)};
}

}  // namespace hirosco::robot_arm
