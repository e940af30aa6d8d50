// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "hirosco/parameter/parameter.hpp"
#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"

namespace hirosco::robot_arm {

/// The drives of an arm's joints, on whatever base, with their sensors: what the device says, and what it is to do.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Drives {
 public:
  /// `current` tells what is measured.
  explicit Drives(Parameter<CurrentValues>& current) noexcept : current_{current} {}

  /// Before port(): the device tells force and moment at the tip, too.
  void take_force() noexcept { tells_force_ = true; }
  [[nodiscard]] bool tells_force() const noexcept { return tells_force_; }
  /// For use_device().
  [[nodiscard]] DevicePortBase& port() noexcept {
    if (tells_force_) return sensing_port_;
    return port_;
  }
  [[nodiscard]] bool alive() const noexcept { return tells_force_ ? sensing_port_.alive() : port_.alive(); }

  /// As if so many joints stood at 0.
  void forget(std::size_t joints) noexcept;
  /// Takes what the device last said, and tells it.
  void measure(State state) noexcept;
  /// Of no length before there is any.
  [[nodiscard]] const Measured& measured() const noexcept { return measured_; }
  /// What the device last said, of the lengths that its descriptor has.
  [[nodiscard]] ArmInput says() const noexcept;
  /// Of a device that tells it.
  [[nodiscard]] TipForce force() const noexcept;

  /// N m or N, from this cycle on.
  void put_out(const Joints& torque) noexcept { output().torque = torque; }
  [[nodiscard]] const Joints& puts_out() noexcept { return output().torque; }

 private:
  [[nodiscard]] ArmOutput& output() noexcept { return tells_force_ ? sensing_port_.output() : port_.output(); }

  Parameter<CurrentValues>& current_;
  DevicePort<ArmInput, ArmOutput> port_;
  DevicePort<SensingArmInput, ArmOutput> sensing_port_;  ///< in its place, where the device tells a force
  bool tells_force_{false};
  Measured measured_;
};

}  // namespace hirosco::robot_arm
