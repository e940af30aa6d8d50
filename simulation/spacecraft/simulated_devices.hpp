// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/utilities/time.hpp"
#include "simulation/spacecraft/catalogues.hpp"
#include "supervisor/supervision/observer.hpp"

namespace hirosco::simulation {

/// The simulated devices of the mission, in its order: made once, and plugged. Those that cannot be are left out, and the observer is told why.
class SimulatedDevices {
 public:
  struct Parts {
    const descriptor::Mission& mission;
    const DeviceCatalogue& makers;
    FlowFactory& flows;
    const Clock& clock;
    supervisor::Observer& observer;
    std::uint64_t seed;
    bool realtime;  ///< which set of limits holds
  };
  explicit SimulatedDevices(const Parts& parts);

  /// Null: there is none of this name.
  [[nodiscard]] SimulatedDevice* find(std::string_view name) noexcept;
  /// When the first of them is due.
  [[nodiscard]] TimePoint next_wake() const noexcept;
  /// Those that are due.
  void step(TimePoint now);
  /// All that this subsystem uses.
  void step_of(std::string_view subsystem, TimePoint now);

 private:
  struct Device {
    const descriptor::SimulatedDevice* described;
    std::unique_ptr<SimulatedDevice> device;
  };

  /// In words why there can be none.
  [[nodiscard]] std::expected<std::unique_ptr<SimulatedDevice>, std::string> make(
      const Parts& parts, const descriptor::SimulatedDevice& described, const MakeDevice& maker);

  std::vector<Device> devices_;
};

}  // namespace hirosco::simulation
