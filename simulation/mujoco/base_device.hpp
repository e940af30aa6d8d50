// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "simulation/mujoco/mujoco_device.hpp"

namespace hirosco::simulation {

/// The base of a robot that floats, in the world of the device of its joints (world="..." of a mission): star tracker, gyro, wheels and
/// thrusters. Its world goes on with that other device; here is told what it looks like, and what is to act on it.
/// At the endnode WHEELS from the subsystem: WHEELS DOUBLE[3], THRUSTERS DOUBLE[3], N m on the base; to it: WHEELS DOUBLE[3], N m s.
/// At the endnode SENSORS to the subsystem: POSITION DOUBLE[3] m, ORIENTATION DOUBLE[4] w x y z, RATE DOUBLE[3] rad/s in the base's axes,
/// VELOCITY DOUBLE[3] m/s. Without a command nothing acts, and wheels go on turning.
/// Faults besides the common ones, each also a <Setting> of its mission:
///   attitude_noise DEG | position_noise M   (standard deviations)
///   wheels H1,H2,H3   (N m s, at once)
///   stuck on|off   (SENSORS go on telling what they told last, as if it were measured anew: nothing tells that but the world)
class BaseDevice final : public SimulatedDevice {
 public:
  static constexpr std::string_view wheels_endnode = "WHEELS";
  static constexpr std::string_view sensors_endnode = "SENSORS";

  BaseDevice(FlowFactory& flows, FlowAddress address, const Settings& settings);

 private:
  [[nodiscard]] Result<> make_world() override;
  void advance(Duration cycle) noexcept override;
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override;
  void write_sensors(OctetWriter& payload) noexcept override;
  void write_sensors_at(std::string_view endnode, OctetWriter& payload) noexcept override;
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;
  void do_heal() noexcept override;
  void tell_wheels(OctetWriter& payload) noexcept;
  void tell_where(OctetWriter& payload) noexcept;
  /// As SENSORS has it.
  using Where = std::array<double, 13>;
  [[nodiscard]] Where measured() noexcept;

  MujocoDevice* joints_;  ///< in whose world it is; null: in none
  Random random_;
  FloatingBase::Vector by_wheels_{}, by_thrusters_{};
  double attitude_noise_rad_{0};
  double position_noise_m_{0};
  std::optional<Where> told_;
  bool stuck_{false};
};

}  // namespace hirosco::simulation
