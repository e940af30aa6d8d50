// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulation/devices/joystick/joystick_handle.hpp"
#include "simulation/devices/joystick/led_hand.hpp"
#include "simulation/devices/joystick/stick.hpp"
#include "simulation/devices/simulated_device.hpp"

namespace hirosco::simulation {

/// The force-reflecting joystick behind its bus, with an operator's hand on it.
/// To the subsystem: POSITION DOUBLE[2], VELOCITY DOUBLE[2] (rad, rad/s), HAND UINT8 (whose hand is on it), HANDS UINT8
/// (those that there are, one bit each). From it: TORQUE DOUBLE[2] (N m), HAND UINT8, INTENT DOUBLE[2] (rad, of a commanded
/// hand). A person's hand is there after the line "stick PATH" or "stick auto"; when its stick is unplugged, so is this
/// device. Its only declared stop is to drop: a hand holds it.
class JoystickDevice final : public SimulatedDevice {
 public:
  static constexpr std::size_t sensor_octets = 34;
  static constexpr std::size_t command_octets = 33;
  static constexpr std::array fault_lines{
      FaultLine{"hand hold 0 0", "the hand holds the middle"},
      FaultLine{"hand wander", "the hand wanders about"},
  };

  /// Whose hand: one that the simulation moves, one that goes where it is commanded, or a person's on a real stick.
  enum class Hand : std::uint8_t { Simulated = 0, Commanded = 1, Person = 2 };

  /// The hand rests at zero until hand() tells otherwise.
  JoystickDevice(FlowFactory& flows, FlowAddress address, const Settings& settings = {},
                 const HandleParameters& handle = {}, OpenStick open_stick = {});

  /// What the operator's hand does from now on; recorded like a fault:
  ///   target A B | hold A B | sine AXIS AMPLITUDE HZ [PHASE] | ramp DX DY SPEED | cartesian DX DY SECONDS | wander
  /// `target` may be told as often as a mouse moves: the hand goes after it and gives way (LedHand).
  /// Unavailable while another hand is on the handle. Angles rad, axes count from 1; DX DY m from the robot's home, SPEED m/s. Also as the fault line "hand ...".
  [[nodiscard]] Result<> hand(std::string_view line);

  [[nodiscard]] const JoystickHandle& handle() const noexcept { return handle_; }
  [[nodiscard]] JoystickHandle& handle() noexcept { return handle_; }
  /// What the motors did in the last cycle.
  [[nodiscard]] const Vec2& motor_torque_n_m() const noexcept { return applied_; }
  [[nodiscard]] bool drives() const noexcept override { return applied_[0] != 0 || applied_[1] != 0; }

 private:
  void advance(Duration cycle) noexcept override;
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override;
  void write_sensors(OctetWriter& payload) noexcept override;
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;

  void lay_on(Hand hand) noexcept;
  void lead(const Vec2& target_rad);
  void take_from_person() noexcept;

  JoystickHandle handle_;
  OpenStick open_stick_;
  std::unique_ptr<Stick> stick_;
  Hand hand_{Hand::Simulated};
  LedHand led_hand_{LedHand::Limits{}};
  bool led_{false};  ///< by led_hand_
  bool wandered_{false};  ///< before the hand was commanded
  Vec2 intent_rad_{};
  Vec2 commanded_{};
  Vec2 applied_{};
};

}  // namespace hirosco::simulation
