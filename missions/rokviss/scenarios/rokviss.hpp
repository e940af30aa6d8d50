// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "missions/rokviss/scenarios/coupled_craft.hpp"
#include "simulation/figures/report_page.hpp"

/// The runs of the rokviss mission that its figures are judged by: each flies the whole spacecraft on virtual time.
namespace hirosco::simulation {

/// When something happened that never did.
inline constexpr double never = std::numeric_limits<double>::infinity();

struct RunSettings {
  std::filesystem::path mission;  ///< the mission file
  std::uint64_t seed{1};
  Plant plant{};
  int repetitions{20};            ///< of each fault
  double endurance_s{1800};       ///< of the long run
};

struct Run {
  std::string_view id;  ///< first part of the names of its figures
  std::string_view title;
  std::string_view how;
  Findings (*fly)(const RunSettings&);
  bool by_default{true};
};

/// In the order of a report.
[[nodiscard]] std::span<const Run> rokviss_runs();
/// Flies one; what makes it end early becomes a problem.
[[nodiscard]] Findings fly(const Run& run, const RunSettings& settings);

/// The craft of a run, with friction and initial values as it wants them.
[[nodiscard]] CraftOptions craft_options(const RunSettings& settings);

// --- the runs; use rokviss_runs() --------------------------------------------------------------------------------------
[[nodiscard]] Findings fly_tracking(const RunSettings& settings);
[[nodiscard]] Findings fly_rail(const RunSettings& settings);
[[nodiscard]] Findings fly_display(const RunSettings& settings);
[[nodiscard]] Findings fly_springs(const RunSettings& settings);
[[nodiscard]] Findings fly_contour(const RunSettings& settings);
[[nodiscard]] Findings fly_remote(const RunSettings& settings);
[[nodiscard]] Findings fly_bounce(const RunSettings& settings);
[[nodiscard]] Findings fly_torque_limit(const RunSettings& settings);
[[nodiscard]] Findings fly_unplugging(const RunSettings& settings);
[[nodiscard]] Findings fly_faults(const RunSettings& settings);
/// Part of fly_faults(): the cases that take more than one step.
void fly_fault_procedures(const RunSettings& settings, Findings& findings);
[[nodiscard]] Findings fly_endurance(const RunSettings& settings);

}  // namespace hirosco::simulation
