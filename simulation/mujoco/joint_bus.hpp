// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "simulation/devices/simulated_device.hpp"
#include "simulation/mujoco/mujoco_robot.hpp"
#include "simulation/world/random.hpp"

namespace hirosco::simulation {

/// Those joints of a robot that are one device's, as its frames have them: in the order of the file TORQUE DOUBLE[n] of the drives, and
/// POSITION, VELOCITY, TORQUE DOUBLE[n] of what is measured.
class JointBus {
 public:
  explicit JointBus(std::uint64_t seed) : random_{seed} {}

  /// `joints` of the robot, in its order.
  void connect(std::vector<std::size_t> joints);
  [[nodiscard]] std::span<const std::size_t> joints() const noexcept { return joints_; }
  /// Standard deviation in the torque sensors.
  void set_noise(double n_m) noexcept { noise_n_m_ = n_m; }

  [[nodiscard]] Result<> take(OctetReader payload) noexcept;
  /// From the world's next step on: what was taken last, or brakes.
  void drive(MujocoRobot& robot, DeviceOutput output) const noexcept;
  void write_sensors(const MujocoRobot& robot, OctetWriter& payload) noexcept;

 private:
  std::vector<std::size_t> joints_;
  std::vector<double> commanded_;
  Random random_;
  double noise_n_m_{0};
};

}  // namespace hirosco::simulation
