// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "hirosco/descriptor/model/mission.hpp"
#include "simulation/campaign/campaign_log.hpp"
#include "simulation/campaign/edited_texts.hpp"
#include "simulation/campaign/finale.hpp"
#include "simulation/campaign/flight_traffic.hpp"
#include "simulation/campaign/pinged_time.hpp"
#include "simulation/campaign/plan.hpp"
#include "simulation/campaign/plan_actions.hpp"
#include "simulation/campaign/planted_defects.hpp"
#include "simulation/campaign/world_trace.hpp"
#include "simulation/spacecraft/modules.hpp"
#include "simulation/spacecraft/spacecraft.hpp"

namespace hirosco::campaign {

/// One flight of a mission under a plan.
class PlannedFlight {
 public:
  /// `defect`: a defect to be found, else null.
  PlannedFlight(const descriptor::Mission& mission, simulation::Modules modules, FlightPlan plan,
                std::unique_ptr<PlantedDefect> defect);

  /// Flies it all. Packet log and trace are whole afterwards.
  void fly();
  [[nodiscard]] const Disk& disk() const noexcept { return disk_; }
  [[nodiscard]] const WorldTrace& trace() const noexcept { return *trace_; }
  /// What the supervisor told, for people.
  [[nodiscard]] const std::string& story() const noexcept { return observer_.text; }

 private:
  struct Observer final : supervisor::Observer {
    void told(OnboardTime, std::string_view line) override;
    const simulation::Spacecraft* craft{nullptr};
    std::string text;
  };

  [[nodiscard]] std::optional<Duration> revives_after() const;

  descriptor::Mission mission_;
  FlightPlan plan_;
  std::unique_ptr<PlantedDefect> defect_;
  simulation::Modules modules_;
  EditedTexts texts_;
  Disk disk_;
  std::unique_ptr<supervisor::Database> unused_{database_on(disk_)};
  Observer observer_;
  // Made when the defect has changed what they are made of.
  std::unique_ptr<simulation::Spacecraft> craft_;
  std::unique_ptr<WorldTrace> trace_;
  std::optional<FlightTraffic> traffic_;
  std::optional<PingedTime> time_;
  std::optional<PlanActions> actions_;
};

}  // namespace hirosco::campaign
