// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "missions/servicer/scenarios/servicer_craft.hpp"
#include "simulation/figures/report_page.hpp"

/// The runs that the servicer is judged by, each in its world: MuJoCo's, which shares nothing with the on-board model but the file.
namespace hirosco::simulation {

struct ServicerSettings {
  std::filesystem::path mission;  ///< the mission file
  std::uint64_t seed{1};
  /// Only the first direction of the runs that fly several: for tests.
  bool brief{false};
};

struct ServicerRun {
  std::string_view id;  ///< first part of the names of its figures
  std::string_view title;
  std::string_view how;
  Findings (*fly)(const ServicerSettings&);
};

/// In the order of a report.
[[nodiscard]] std::span<const ServicerRun> servicer_runs();
/// Flies one; what makes it end early becomes a problem.
[[nodiscard]] Findings fly(const ServicerRun& run, const ServicerSettings& settings);

}  // namespace hirosco::simulation
