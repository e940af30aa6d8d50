// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulation/devices/simulated_device.hpp"
#include "simulation/world/joystick_handle.hpp"

namespace hirosco::simulation {

/// The force-reflecting joystick behind its bus, with an operator's hand on it.
/// To the subsystem: POSITION DOUBLE[2], VELOCITY DOUBLE[2] (rad, rad/s). From it: TORQUE DOUBLE[2] (N m).
class JoystickDevice final : public SimulatedDevice {
 public:
  static constexpr std::size_t sensor_octets = 32;
  static constexpr std::size_t command_octets = 16;

  /// The hand rests at zero until hand() tells otherwise.
  JoystickDevice(FlowFactory& flows, FlowAddress address, const Settings& settings = {},
                 const HandleParameters& handle = {});

  /// What the operator's hand does from now on; recorded like a fault:
  ///   hold A B | sine AXIS AMPLITUDE HZ [PHASE] | ramp DX DY SPEED | cartesian DX DY SECONDS | wander
  /// Angles rad, axes count from 1; DX DY m from the robot's home, SPEED m/s. Also as the fault line "hand ...".
  [[nodiscard]] Result<> hand(std::string_view line);

  [[nodiscard]] const JoystickHandle& handle() const noexcept { return handle_; }
  [[nodiscard]] JoystickHandle& handle() noexcept { return handle_; }
  /// What the motors did in the last cycle.
  [[nodiscard]] const Vec2& motor_torque_n_m() const noexcept { return applied_; }

 private:
  void advance(Duration cycle) noexcept override;
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override;
  void write_sensors(OctetWriter& payload) noexcept override;
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;

  JoystickHandle handle_;
  Vec2 commanded_{};
  Vec2 applied_{};
};

}  // namespace hirosco::simulation
