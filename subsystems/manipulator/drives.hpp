// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "subsystems/manipulator/parameters.hpp"

namespace hirosco::manipulator {

/// The drives of the joints with their sensors, and the tool: what the device says, and what it is to do.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Drives {
 public:
  /// `parameters`: CUR_VALUES tells what is measured.
  explicit Drives(Parameters& parameters) noexcept : parameters_{parameters} {}

  /// For use_device().
  [[nodiscard]] DevicePortBase& port() noexcept { return port_; }
  [[nodiscard]] bool alive() const noexcept { return port_.alive(); }
  /// What is a number for each joint, of descriptor and device, has to be `joints` long.
  [[nodiscard]] Result<> check_lengths(std::size_t joints) noexcept;

  /// Tells what the device last said.
  void tell(State state) noexcept;
  [[nodiscard]] const RobotInput& sensed() const noexcept { return port_.input(); }
  /// The same, as the law takes it.
  [[nodiscard]] Measured measured() const noexcept;

  /// N m, from this cycle on.
  void put_out(const Joints& torque_n_m) noexcept { port_.output().torque_n_m = torque_n_m; }
  void put_nothing_out() noexcept { port_.output() = {}; }
  [[nodiscard]] const Joints& puts_out() noexcept { return port_.output().torque_n_m; }
  /// What the tool is to hold, 0: nothing.
  void hold(std::uint8_t tool) noexcept { port_.output().tool = tool; }

 private:
  Parameters& parameters_;
  DevicePort<RobotInput, RobotOutput> port_;
};

}  // namespace hirosco::manipulator
