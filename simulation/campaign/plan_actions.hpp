// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "simulation/campaign/campaign_log.hpp"
#include "simulation/campaign/edited_texts.hpp"
#include "simulation/campaign/flight_traffic.hpp"
#include "simulation/campaign/plan.hpp"
#include "simulation/campaign/planted_defects.hpp"
#include "simulation/campaign/world_trace.hpp"

namespace hirosco::campaign {

/// Does what a plan says, action by action, and ends the faults that it has made.
class PlanActions {
 public:
  struct Parts {
    const descriptor::Mission& mission;
    simulation::Spacecraft& craft;
    const PlantedDefect& defect;
    Disk& disk;
    WorldTrace& trace;
    FlightTraffic& traffic;
    EditedTexts& texts;
  };
  explicit PlanActions(const Parts& parts) : parts_{parts} {}

  /// Nothing, where the supervisor has finished.
  void perform(const Action& action);
  /// Every fault is over.
  void end_faults();
  /// Nobody moves a handle: where a hand had held it away the robot may stand at the end of the rail, and whoever wanders on from there trips
  /// limits, and rightly so.
  void rest_hands();

 private:
  [[nodiscard]] bool do_action(const std::vector<std::string>& words);
  [[nodiscard]] bool supervisor_fault(const std::vector<std::string>& words);
  [[nodiscard]] bool disk_fault(const std::vector<std::string>& words);
  [[nodiscard]] bool telecommand(const std::vector<std::string>& words);
  [[nodiscard]] bool edit(const std::vector<std::string>& words);
  [[nodiscard]] bool flood(const std::vector<std::string>& words);

  Parts parts_;
  bool supervisor_stopped_{false};
};

}  // namespace hirosco::campaign
