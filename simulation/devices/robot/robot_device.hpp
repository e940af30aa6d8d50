// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulation/devices/robot/world/two_joint_arm.hpp"
#include "simulation/devices/simulated_device.hpp"
#include "simulation/world/random.hpp"

namespace hirosco::simulation {

struct RobotSensors {
  bool quantized{true};              ///< 17 bit per turn: motor side before the gear of 160, link side behind it
  double torque_noise_n_m{0};        ///< standard deviation
};

/// The robot of the demonstrator behind its joint bus.
/// To the subsystem: MOTOR_POSITION DOUBLE[2], MOTOR_VELOCITY DOUBLE[2], POSITION DOUBLE[2], VELOCITY DOUBLE[2],
/// TORQUE DOUBLE[2], TEMPERATURE FLOAT[2], SPRING UINT8 (rad, rad/s, N m, C; the spring that is hooked, 0: none).
/// From it: TORQUE DOUBLE[2] of the motors, SPRING UINT8: a change of it hooks or releases, and hooks nothing that is not
/// within reach of the tip.
/// Has every declared stop. A controlled one damps and gives way by the joints' own sensors, then holds what load is left;
/// after it, and to hold at once, the brakes grip. They slip beyond brake_torque_n_m.
/// Faults besides the common ones:
///   temperature JOINT C | hook SPRING | release | friction on|off | noise N_M | thermal_accel FACTOR
///   (joints and springs count from 1)
class RobotDevice final : public SimulatedDevice {
 public:
  static constexpr std::size_t sensor_octets = 5 * 16 + 2 * 4 + 1;
  static constexpr std::size_t command_octets = 17;
  static constexpr double brake_torque_n_m = 30;
  static constexpr std::array fault_lines{
      FaultLine{"temperature 1 60", "joint 1 at 60 degC: a warning"},
      FaultLine{"temperature 1 72", "joint 1 at 72 degC: critical"},
      FaultLine{"temperature 1 85", "joint 1 at 85 degC: too hot"},
      FaultLine{"friction off", "joints without friction"},
      FaultLine{"friction on", "joints with friction"},
  };

  RobotDevice(FlowFactory& flows, FlowAddress address, const Settings& settings = {}, const ArmParameters& arm = {},
              const RobotSensors& sensors = {});

  /// World truth: tip, contact, joint torque, temperature.
  [[nodiscard]] const TwoJointArm& arm() const noexcept { return arm_; }
  [[nodiscard]] TwoJointArm& arm() noexcept { return arm_; }
  /// What the motors did in the last cycle, and what the brakes.
  [[nodiscard]] const Vec2& motor_torque_n_m() const noexcept { return applied_; }
  [[nodiscard]] bool drives() const noexcept override { return applied_[0] != 0 || applied_[1] != 0; }
  [[nodiscard]] const Vec2& brake_n_m() const noexcept { return brake_; }

 private:
  void ask_for(std::uint8_t spring) noexcept;
  void advance(Duration cycle) noexcept override;
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override;
  void write_sensors(OctetWriter& payload) noexcept override;
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;
  void do_heal() noexcept override;
  [[nodiscard]] bool can(Stop) const noexcept override { return true; }
  [[nodiscard]] Vec2 coming_to_rest() noexcept;
  [[nodiscard]] Vec2 gripping(const Vec2& load_n_m, double stiffness_n_m_per_rad) noexcept;

  TwoJointArm arm_;
  RobotSensors sensors_;
  double made_noise_n_m_;
  double made_thermal_acceleration_;
  Random random_;
  Vec2 commanded_{};
  std::uint8_t spring_asked_{0};
  Vec2 applied_{};
  Vec2 brake_{};
  DeviceOutput output_before_{DeviceOutput::Off};
  std::optional<Vec2> gripped_rad_;  ///< where it is held without load
};

}  // namespace hirosco::simulation
