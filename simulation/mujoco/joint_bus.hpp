// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "simulation/devices/simulated_device.hpp"
#include "simulation/mujoco/mujoco_robot.hpp"
#include "simulation/mujoco/relative_encoders.hpp"
#include "simulation/world/random.hpp"

namespace hirosco::simulation {

/// Those joints of a robot that are one device's, as its frames have them: in the order of the file TORQUE DOUBLE[n] of the drives, and
/// POSITION, VELOCITY, TORQUE DOUBLE[n] of what is measured. With relative encoders REFERENCE UINT8[n] besides, and REFERENCED UINT8[n].
class JointBus {
 public:
  explicit JointBus(std::uint64_t seed) : random_{seed} {}

  /// `joints` of the robot, in its order.
  void connect(std::vector<std::size_t> joints);
  [[nodiscard]] std::span<const std::size_t> joints() const noexcept { return joints_; }
  /// Standard deviation in the torque sensors.
  void set_noise(double n_m) noexcept { noise_n_m_ = n_m; }
  /// From now on its joints are measured by these, which are of all joints of the robot.
  void count_with(RelativeEncoders encoders) { encoders_ = std::move(encoders); }
  [[nodiscard]] bool counts() const noexcept { return encoders_.has_value(); }
  /// This joint of the robot, by encoders that count.
  [[nodiscard]] bool knows_zero(std::size_t joint) const noexcept { return encoders_->knows_zero(joint); }
  /// They know nothing of what was before.
  void forget_zeros() noexcept {
    if (encoders_) encoders_->forget();
  }

  [[nodiscard]] Result<> take(OctetReader payload) noexcept;
  /// From the world's next step on: what was taken last, or brakes.
  void drive(MujocoRobot& robot, DeviceOutput output) const noexcept;
  void write_sensors(const MujocoRobot& robot, OctetWriter& payload) noexcept;
  /// Encoders that count see where their joints are; each step, so that no mark is passed unseen.
  void count(const MujocoRobot& robot) noexcept;
  /// Behind all else that is measured: which joints know their zero; of encoders that count.
  void write_references(OctetWriter& payload) const noexcept;

 private:
  std::vector<std::size_t> joints_;
  std::vector<double> commanded_;
  Random random_;
  double noise_n_m_{0};
  std::optional<RelativeEncoders> encoders_;
};

}  // namespace hirosco::simulation
