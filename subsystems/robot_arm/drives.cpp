// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/drives.hpp"

namespace hirosco::robot_arm {

void Drives::forget(std::size_t joints) noexcept {
  measured_.position = measured_.velocity = measured_.torque = JointVector::Zero(static_cast<Eigen::Index>(joints));
}

void Drives::measure(const Cycle& cycle) noexcept {
  const ArmInput in = says();
  sample_time_.update(cycle.planned, cycle.period, cycle.count == 0, port().fresh());
  current_.store({static_cast<std::int32_t>(cycle.state), in.position, in.velocity, in.torque, port().flags()});
  measured_ = {vector_of(in.position), vector_of(in.velocity), vector_of(in.torque)};
}

ArmInput Drives::says() const noexcept {
  return with_port(*this, [](const auto& port) {
    const auto& in = port.input();
    return ArmInput{in.position, in.velocity, in.torque};
  });
}

TipForce Drives::force() const noexcept {
  return with_port(*this, [](const auto& port) {
    const auto& in = port.input();
    if constexpr (requires { in.force_n; }) return TipForce{in.force_n, in.moment_n_m, in.age_ms};
    else return TipForce{};
  });
}

JointFlags Drives::references() const noexcept {
  return with_port(*this, [](const auto& port) {
    const auto& in = port.input();
    if constexpr (requires { in.referenced; }) return in.referenced;
    else return JointFlags{};
  });
}

bool Drives::referenced(std::size_t joint) const noexcept {
  if (!tells_references_) return true;
  const JointFlags told = references();
  return joint < told.size() && told[joint] == 1;
}

std::optional<std::size_t> Drives::not_referenced(std::size_t joints) const noexcept {
  for (std::size_t joint = 0; joint < joints; ++joint)
    if (!referenced(joint)) return joint;
  return std::nullopt;
}

void Drives::take_zero(const JointFlags& joints) noexcept {
  with_port(*this, [&](auto& port) {
    if constexpr (requires { port.output().reference; }) port.output().reference = joints;
  });
}

std::size_t Drives::takes_zeros() noexcept {
  return with_port(*this, [](auto& port) -> std::size_t {
    if constexpr (requires { port.output().reference; }) return port.output().reference.size();
    else return 0;
  });
}

}  // namespace hirosco::robot_arm
