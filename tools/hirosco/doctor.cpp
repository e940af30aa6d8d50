// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "hirosco/utilities/version.hpp"
#include "tools/doctor/rows.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/json_line.hpp"
#include "tools/hirosco/look_at.hpp"
#include "tools/hirosco/readiness.hpp"

namespace hirosco::tools {
namespace {

using doctor::Finding;
using doctor::Row;
using doctor::Verdict;

void print_json(const Row& row, const Finding& finding) {
  fmt::print("{}\n", json_line({{"row", row.name},
                                {"verdict", to_text(finding.verdict)},
                                {"good_for", row.good_for},
                                {"found", finding.found},
                                {"mends", finding.mends}}));
}

void print_text(const Row& row, const Finding& finding) {
  fmt::print("{:<13}  {:<16}  {}\n", to_text(finding.verdict), row.name, finding.found);
  if (finding.verdict == Verdict::Ok) return;
  fmt::print("{:<13}  {:<16}  for: {}\n", "", "", row.good_for);
  if (!finding.mends.empty()) fmt::print("{:<13}  {:<16}  $ {}\n", "", "", finding.mends);
}

}  // namespace

int look_after(const DoctorOptions& options) {
  const std::string name = options.mission.empty() ? usual_mission() : options.mission;
  if (name.empty()) {
    fmt::print(stderr, "hirosco doctor: for which mission? there is no usual one here\n");
    return exit_usage;
  }
  const auto mission = load_mission(name);
  if (!mission) return exit_finding;
  auto system = doctor::look_at(*mission);
  for (const auto& problem : unready(*mission, FlownAs::Processes))
    system.not_ready.push_back(fmt::format("{} {}", problem.code, problem.message));
  std::map<Verdict, int> counts;
  int slower = 0;  // of those, what keeps nothing from flying
  for (const Row& row : doctor::rows()) {
    const Finding finding = row.judge(system);
    ++counts[finding.verdict];
    if (finding.verdict == Verdict::Missing && doctor::of_time(row)) ++slower;
    (options.json ? print_json : print_text)(row, finding);
  }
  const int missing = counts[Verdict::Missing];
  if (!options.json) {
    const std::string_view how = missing == 0        ? "flies here with its figures"
                                 : missing == slower ? "flies here, with cycles later than its figures say"
                                                     : "does not fly here with its figures";
    const std::string lacks = missing == 0 ? "" : fmt::format("{} missing: ", missing);
    const std::string_view whose =
        options.mission.empty() ? "; no mission was named, of yours says it: hirosco doctor FILE" : "";
    fmt::print("hirosco {}: {}{} {}{}\n", version, lacks, mission->name, how, whose);
  }
  return missing == 0 ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
