// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/planned_flight.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "simulation/spacecraft/flight_origin.hpp"

namespace hirosco::campaign {
namespace {

/// Of each member's program, beside the mission's own: what REPLACE puts in its place.
constexpr std::array<std::string_view, 2> flown_versions{"2", "3"};

}  // namespace

void PlannedFlight::Observer::told(OnboardTime, std::string_view line) {
  const double now_s = craft != nullptr ? seconds(craft->now() - start_of_flight) : 0.0;
  text += fmt::format("{:.6f} {}\n", now_s, line);
}

PlannedFlight::PlannedFlight(const descriptor::Mission& mission, simulation::Modules modules, FlightPlan plan,
                             std::unique_ptr<PlantedDefect> defect)
    : mission_{mission},
      plan_{std::move(plan)},
      defect_{defect ? std::move(defect) : std::make_unique<PlantedDefect>()},
      modules_{std::move(modules)},
      texts_{mission_, descriptor::file_system()} {
  if (!plan_.mode.empty()) mission_.start_mode = plan_.mode;
  if (plan_.ends.empty()) plan_.ends = {mission_.start_mode.empty() ? mission_.initial_mode : mission_.start_mode};
  defect_->mission = &mission_;
  if (defect_->edit) defect_->edit(mission_);
  if (defect_->devices) defect_->devices(modules_.devices);
  // Other versions are the same program again: what is seen of them is which one runs.
  for (const auto& member : mission_.subsystems)
    for (const std::string_view version : flown_versions)
      if (const auto own = modules_.subsystems.find(member.executable); own != modules_.subsystems.end())
        modules_.subsystems.emplace(fmt::format("{}@{}", member.executable, version), own->second);
  disk_.keeps = defect_->keeps;
  craft_ = std::make_unique<simulation::Spacecraft>(simulation::Spacecraft::Parts{
      .mission = mission_,
      .subsystems = modules_.subsystems,
      .devices = modules_.devices,
      .log = *unused_,
      .observer = observer_,
      .seed = plan_.seed,
      .make_log = [this](const Clock& clock) { return log_on(disk_, clock); },
      .make_log_readings = [this](const Clock& clock) { return readings_on(disk_, clock); },
      .open_database = [this](supervisor::DatabaseStrategy) { return database_on(disk_); },
      .wrap_channel = defect_->wrap_channel,
      .mistake_version = defect_->mistake_version,
      .links = defect_->links,
      .files = texts_.source(defect_->reads),
      .revives_after = revives_after()});
  defect_->craft = craft_.get();
  observer_.craft = craft_.get();
  trace_ = std::make_unique<WorldTrace>(mission_, *craft_, defect_->clock_percent,
                                        simulation::origin_of(mission_, *craft_, plan_.seed));
  traffic_.emplace(mission_, *craft_, *trace_);
  time_.emplace(PingedTime::Parts{
      .mission = mission_, .craft = *craft_, .defect = *defect_, .trace = *trace_, .traffic = *traffic_});
  actions_.emplace(PlanActions::Parts{.mission = mission_,
                                      .craft = *craft_,
                                      .defect = *defect_,
                                      .disk = disk_,
                                      .trace = *trace_,
                                      .traffic = *traffic_,
                                      .texts = texts_});
}

/// A keeper stands behind the supervisors of flights that lose one; without it those of the others fly as they always have.
std::optional<Duration> PlannedFlight::revives_after() const {
  constexpr Duration next_one_takes = 300ms;
  const bool loses_supervisor = std::ranges::any_of(plan_.actions, [&](const Action& action) {
    const auto& words = action.words;
    return words.size() > 1 && (words[0] == "kill" || words[0] == "hang") && words[1] == mission_.supervisor.name;
  });
  return loses_supervisor ? std::optional{next_one_takes} : std::nullopt;
}

void PlannedFlight::fly() {
  for (const Action& action : plan_.actions) {
    if (action.at >= plan_.finale) break;
    time_->run_until(action.at);
    actions_->perform(action);
  }
  time_->run_until(plan_.finale);
  Finale{{.mission = mission_,
          .craft = *craft_,
          .trace = *trace_,
          .traffic = *traffic_,
          .actions = *actions_,
          .time = *time_,
          .ends = plan_.ends}}
      .fly(plan_.finale);
  trace_->say("end");
}

}  // namespace hirosco::campaign
