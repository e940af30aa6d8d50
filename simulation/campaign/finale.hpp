// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/campaign/flight_traffic.hpp"
#include "simulation/campaign/pinged_time.hpp"
#include "simulation/campaign/plan_actions.hpp"

namespace hirosco::campaign {

/// The same end for every flight: the faults stop, SAFE_ALL stops the craft, and two seconds later all that lives, and does not hang, can be
/// brought up by ground's telecommands and stays up (I10; hazard SF14).
class Finale {
 public:
  struct Parts {
    const descriptor::Mission& mission;
    simulation::Spacecraft& craft;
    WorldTrace& trace;
    FlightTraffic& traffic;
    PlanActions& actions;
    PingedTime& time;
    const std::vector<std::string>& ends;  ///< modes of the mission, one at least: FlightPlan
  };
  explicit Finale(const Parts& parts) : parts_{parts} {}

  /// From now on.  \param begin The same as the plan says it, since the start of the flight.
  void fly(Duration begin);

 private:
  void see_hangs_ended();
  void bring_up();
  [[nodiscard]] bool call(std::string_view subsystem, std::string_view function, std::optional<double> argument);
  [[nodiscard]] std::uint32_t state(std::string_view name) const;

  Parts parts_;
};

}  // namespace hirosco::campaign
