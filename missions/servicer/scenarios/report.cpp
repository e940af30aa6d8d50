// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/servicer/scenarios/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "missions/servicer/scenarios/servicer.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::servicer {
namespace {

using simulation::Chapter;

[[nodiscard]] int verdict(const std::vector<Chapter>& chapters) {
  fmt::print("{}", simulation::verdict_line(chapters));
  return std::ranges::all_of(chapters, &Chapter::holds) ? tools::exit_ok : tools::exit_finding;
}

}  // namespace

int report(const ReportOptions& options) {
  const auto table = simulation::ExpectedTable::read(options.mission.parent_path() / "expected.csv");
  if (!table) {
    fmt::print(stderr, "hirosco report: {}\n", table.error());
    return tools::exit_finding;
  }
  const auto runs = simulation::servicer_runs();
  for (const std::string& id : options.only)
    if (std::ranges::find(runs, id, &simulation::ServicerRun::id) == runs.end()) {
      fmt::print(stderr, "hirosco report: no run '{}'; there are SV1 SV2 SV3 SV4 SV8 SV9\n", id);
      return tools::exit_usage;
    }
  std::vector<Chapter> chapters;
  for (const auto& run : runs) {
    if (!options.only.empty() && std::ranges::find(options.only, run.id) == options.only.end()) continue;
    Chapter chapter{std::string{run.id},
                    std::string{run.title},
                    std::string{run.how},
                    simulation::fly(run, {.mission = options.mission, .seed = options.seed}),
                    {}};
    chapter.rows = simulation::judged(*table, chapter.id, chapter.findings.figures);
    fmt::print("{}", text_of(chapter));
    std::fflush(stdout);
    chapters.push_back(std::move(chapter));
  }
  if (!options.out.empty()) {
    const auto written = write_page(
        options.out, "Report on mission servicer",
        fmt::format(
            "Flown by hirosco report servicer --seed {}; every figure from the world of the whole spacecraft on "
            "virtual time.",
            options.seed),
        chapters);
    if (!written) {
      fmt::print(stderr, "hirosco report: {}: {}\n", options.out,
                 std::strerror(static_cast<int>(written.error().value)));
      return tools::exit_environment;
    }
    fmt::print("\nwritten: {}\n", (std::filesystem::path{options.out} / "index.html").string());
  }
  return verdict(chapters);
}

}  // namespace hirosco::servicer
