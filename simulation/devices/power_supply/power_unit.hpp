// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "simulation/devices/simulated_device.hpp"

namespace hirosco::simulation {

/// Array, battery and two outlets of a craft: sun and eclipse come by fault lines, the battery takes what is left over and gives what is
/// lacking. Its outlets latch: they stay as they were commanded last, whoever is silent. No noise.
class PowerUnit final : public SimulatedDevice {
 public:
  static constexpr std::array fault_lines{
      FaultLine{"sun_angle 70", "the sun at 70 deg from the array's normal"},
      FaultLine{"eclipse on", "no sun; off: again"},
      FaultLine{"charge 0.35", "the battery is charged to 35 %"},
      FaultLine{"array 0.5", "half of the cells are lost"},
      FaultLine{"platform_load 200", "what the platform draws, W"},
      FaultLine{"payload_load 260", "what the payload draws while its outlet is on, W"},
  };

  PowerUnit(FlowFactory& flows, FlowAddress address, const Settings& settings);

  [[nodiscard]] double charge() const noexcept { return charge_; }
  [[nodiscard]] bool payload_on() const noexcept { return payload_on_; }
  /// That the array can give now.
  [[nodiscard]] double array_w() const noexcept;
  [[nodiscard]] double loads_w() const noexcept;
  /// By its charge; 0: nothing feeds the loads.
  [[nodiscard]] double bus_v() const noexcept;

 private:
  void advance(Duration cycle) noexcept override;
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override;
  void write_sensors(OctetWriter& payload) noexcept override;
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;
  void do_heal() noexcept override;

  double sun_angle_deg_{0};
  bool eclipse_{false};
  double cells_{1};  ///< share of them that is there
  double charge_{0.9};
  double platform_w_{200}, payload_w_{260};
  bool payload_on_{false};
};

}  // namespace hirosco::simulation
