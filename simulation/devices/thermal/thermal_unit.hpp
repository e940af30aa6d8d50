// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "simulation/devices/simulated_device.hpp"
#include "simulation/devices/thermal/thermal_network.hpp"
#include "simulation/world/random.hpp"

namespace hirosco::simulation {

/// Zones of a craft, each with a temperature sensor and a heater of two switches in a row: one that is switched in each cycle, one that
/// takes the line. Sun and eclipse come by fault lines. While nobody speaks to it, or it is told so, it keeps its zones by thermostats of its
/// own, as far as their lines are closed.
class ThermalUnit final : public SimulatedDevice {
 public:
  static constexpr std::size_t most_zones = ThermalNetwork::most_nodes;
  static constexpr std::array fault_lines{
      FaultLine{"eclipse on", "no sun; off: again"},
      FaultLine{"sensor 3 dead", "sensor of zone 3 says -273.15 degC; stuck: what it says now; well: again right"},
      FaultLine{"sensor_offset 3 5", "sensor of zone 3 says 5 K more"},
      FaultLine{"heater 3 stuck_on",
                "the switch of heater 3 does not open; stuck_off: does not close; well: again right"},
      FaultLine{"temperature 3 -20", "zone 3 has -20 degC"},
      FaultLine{"temperatures 10", "all zones have 10 degC"},
      FaultLine{"noise 0.02", "of each sensor, K (1 sigma)"},
      FaultLine{"faster 60", "its world runs 60 times as fast as the craft; 1: as it is"},
      FaultLine{"zones 12", "how many there are: those that its subsystem speaks of"},
      FaultLine{"heaters_w 10", "what each heater draws, W; of all or, with commas, of each"},
      FaultLine{"capacities_j_k 3000", "of each zone, J/K"},
      FaultLine{"radiating_m2 0.02", "of each zone: emissivity times area"},
      FaultLine{"inside_w 3", "what is turned into heat in each zone by what works there"},
      FaultLine{"sunlit_w 2", "what the sun gives each zone"},
      FaultLine{"neighbours_w_k 0.02", "between each zone and the next, W/K"},
      FaultLine{"keeps -12 -8", "its own thermostats: on below, off above"},
  };

  ThermalUnit(FlowFactory& flows, FlowAddress address, const Settings& settings);

  [[nodiscard]] double temperature_c(std::size_t zone) const noexcept { return network_.temperature_c(zone); }
  [[nodiscard]] bool heats(std::size_t zone) const noexcept;
  [[nodiscard]] double drawn_w() const noexcept;

 private:
  using Values = std::array<double, most_zones>;
  enum class SensorFault : std::uint8_t { None, Dead, Stuck };
  enum class HeaterFault : std::uint8_t { None, StuckOn, StuckOff };
  struct Zone {
    bool on{false};
    bool line{true};
    bool own_on{false};  ///< of its own thermostat
    SensorFault sensor{SensorFault::None};
    HeaterFault heater{HeaterFault::None};
    float stuck_at_c{0};
    double offset_k{0};
  };

  void advance(Duration cycle) noexcept override;
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override;
  void write_sensors(OctetWriter& payload) noexcept override;
  [[nodiscard]] Result<> do_fault(const Words& words) override;
  [[nodiscard]] std::string do_truth() const override;
  void do_heal() noexcept override;

  [[nodiscard]] std::size_t count() const noexcept { return network_.count(); }
  [[nodiscard]] float reading_c(std::size_t zone) noexcept;
  [[nodiscard]] Result<std::size_t> zone_of(const Words& words) const;
  [[nodiscard]] Result<> fault_of_zone(const Words& words);
  [[nodiscard]] Result<> set_world(const Words& words);
  [[nodiscard]] Result<> set_each(std::string_view name, std::string_view numbers);
  void couple() noexcept;

  ThermalNetwork network_;
  std::array<Zone, most_zones> zones_{};
  Values heater_w_{}, inside_w_{}, sunlit_w_{};
  double neighbours_w_k_{0.02};
  double noise_k_{0};
  double faster_{1};
  double keeps_from_c_{-12}, keeps_to_c_{-8};
  bool eclipse_{false};
  bool own_{true};
  Random random_;
};

}  // namespace hirosco::simulation
