// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "subsystems/robot_gripper/control/fingers.hpp"
#include "subsystems/robot_gripper/parameters.hpp"

namespace hirosco::robot_gripper {

/// The drives of the finger joints with their sensors: what the device says, as numbers of joints and of the gap, and what it is to do.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Drives {
 public:
  /// `fingers`: that are driven. `parameters`: CUR_VALUES tells what is measured.
  Drives(const Fingers& fingers, Parameters& parameters) noexcept : fingers_{fingers}, parameters_{parameters} {}

  /// For use_device().
  [[nodiscard]] DevicePortBase& port() noexcept { return port_; }
  [[nodiscard]] bool alive() const noexcept { return port_.alive(); }
  /// What is a number for each joint, of device and descriptor, has to be `joints` long.
  [[nodiscard]] Result<> check_lengths(std::size_t joints) noexcept;

  /// Takes what the device last said, and tells it.
  void measure(State state) noexcept;
  [[nodiscard]] const Measured& measured() const noexcept { return measured_; }
  [[nodiscard]] const Gap& gap() const noexcept { return gap_; }

  /// N m or N, from this cycle on.
  void put_out(const Joints& torques) noexcept { port_.output().torque = torques; }
  void put_nothing_out() noexcept { put_out(Joints::zeros(fingers_.count())); }
  [[nodiscard]] const Joints& puts_out() noexcept { return port_.output().torque; }

 private:
  const Fingers& fingers_;
  Parameters& parameters_;
  DevicePort<GripperInput, GripperOutput> port_;
  Measured measured_;
  Gap gap_;
};

}  // namespace hirosco::robot_gripper
