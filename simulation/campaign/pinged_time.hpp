// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "simulation/campaign/flight_traffic.hpp"
#include "simulation/campaign/planted_defects.hpp"
#include "simulation/campaign/world_trace.hpp"

namespace hirosco::campaign {

/// The time of a flight: ground pings the supervisor all the time, as it has to answer whatever happens (I6), and the world is looked at in
/// each instant. It ends with the supervisor.
class PingedTime {
 public:
  struct Parts {
    const descriptor::Mission& mission;
    simulation::Spacecraft& craft;
    const PlantedDefect& defect;
    WorldTrace& trace;
    FlightTraffic& traffic;
  };
  explicit PingedTime(const Parts& parts) : parts_{parts} {}

  void run_until(Duration since_start);
  void run(Duration span);
  /// At most for `limit`.
  void run_until(const std::function<bool()>& condition, Duration limit);

 private:
  void look();

  Parts parts_;
};

}  // namespace hirosco::campaign
