// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/joint_bus.hpp"

#include <cmath>
#include <utility>

namespace hirosco::simulation {

void JointBus::connect(std::vector<std::size_t> joints) {
  joints_ = std::move(joints);
  commanded_.assign(joints_.size(), 0.0);
}

Result<> JointBus::take(OctetReader payload) noexcept {
  for (double& torque : commanded_) {
    torque = payload.get<double>();
    if (!std::isfinite(torque)) torque = 0;
  }
  if (encoders_)
    for (const std::size_t i : joints_) encoders_->take_zero(i, payload.get<std::uint8_t>() == 1);
  if (!payload.exhausted()) return fail(ErrorCode::Malformed, "torque command size");
  return ok();
}

void JointBus::drive(MujocoRobot& robot, DeviceOutput output) const noexcept {
  using Brakes = MujocoRobot::Brakes;
  const bool driven = output == DeviceOutput::Active;
  const Brakes brakes = driven ? Brakes::Open : output == DeviceOutput::Stopping ? Brakes::Slowing : Brakes::Closed;
  for (std::size_t i = 0; i < joints_.size(); ++i) robot.drive(joints_[i], driven ? commanded_[i] : 0, brakes);
}

void JointBus::write_sensors(const MujocoRobot& robot, OctetWriter& payload) noexcept {
  for (const std::size_t i : joints_)
    payload.put(encoders_ ? encoders_->read(i, robot.position(i)) : robot.position(i));
  for (const std::size_t i : joints_) payload.put(robot.velocity(i));
  for (const std::size_t i : joints_)
    payload.put(robot.torque(i) + (noise_n_m_ > 0 ? noise_n_m_ * random_.normal() : 0));
}

void JointBus::count(const MujocoRobot& robot) noexcept {
  if (!encoders_) return;
  for (const std::size_t i : joints_) static_cast<void>(encoders_->read(i, robot.position(i)));
}

void JointBus::write_references(OctetWriter& payload) const noexcept {
  if (!encoders_) return;
  for (const std::size_t i : joints_) payload.put(static_cast<std::uint8_t>(encoders_->knows_zero(i) ? 1 : 0));
}

}  // namespace hirosco::simulation
