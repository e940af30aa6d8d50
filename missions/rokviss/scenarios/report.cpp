// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "missions/rokviss/scenarios/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "missions/rokviss/scenarios/report_real.hpp"
#include "missions/rokviss/scenarios/rokviss.hpp"
#include "missions/rokviss/scenarios/rokviss_corners.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::rokviss {
namespace {

using simulation::Chapter;
using tools::exit_environment;
using tools::exit_finding;
using tools::exit_ok;
using tools::exit_usage;

/// "mass=1.01" into the plant; false for what is none.
[[nodiscard]] bool plant_one(const std::string& text, simulation::Plant& plant) {
  const auto equals = text.find('=');
  if (equals == text.npos) return false;
  const std::string name = text.substr(0, equals);
  char* end = nullptr;
  const double factor = std::strtod(text.c_str() + equals + 1, &end);
  if (*end != '\0' || end == text.c_str() + equals + 1 || !(factor > 0) || !std::isfinite(factor)) return false;
  if (name == "stiffness") plant.stiffness = factor;
  else if (name == "rail") plant.rail = factor;
  else if (name == "mass") plant.mass = factor;
  else if (name == "force_scale") plant.force_scale = factor;
  else if (name == "hand_clock") plant.hand_clock = factor;
  else if (name == "delay_ms") plant.delay_ms = factor;
  else return false;
  return true;
}

/// How the world of a run was integrated, and how far its figures move when it is integrated twice as finely.
[[nodiscard]] std::string integrated(const simulation::Run& run, simulation::RunSettings settings,
                                     const simulation::Figures& figures, const simulation::ExpectedTable& table,
                                     bool compare) {
  const double longest_us = 1e6 * seconds(simulation::ArmParameters{}.largest_sub_step) * settings.plant.sub_step;
  std::string text =
      fmt::format("Robot's world: Runge-Kutta 4, sub-steps of at most {:g} us, shorter in hard contact.", longest_us);
  if (!compare) return text;
  settings.plant.sub_step /= 2;
  std::string moved;
  double largest = 0;
  for (const auto& [name, finer] : fly(run, settings).figures) {
    const auto before = figures.find(name);
    const auto* expected = table.find(name);
    if (before == figures.end() || expected == nullptr || before->second == finer) continue;
    // A near zero figure is measured by what the table has it at.
    const double share = std::abs(finer - before->second) /
                         std::max({std::abs(before->second), std::abs(expected->value), expected->tolerance});
    if (share <= largest) continue;
    largest = share;
    moved = name;
  }
  return text + (moved.empty() ? " Half as long they change no figure."
                               : fmt::format(" Half as long they move {} by {:.2g} %, all others by less.", moved,
                                             100 * largest));
}

/// The runs that were asked for, in the order of the report; empty after a word about one that does not exist.
[[nodiscard]] std::vector<simulation::Run> chosen(const ReportOptions& options) {
  const auto all = simulation::rokviss_runs();
  for (const std::string& id : options.only) {
    if (std::ranges::find(all, id, &simulation::Run::id) != all.end()) continue;
    fmt::print(stderr, "hirosco report: no run '{}'; there are", id);
    for (const auto& run : all) fmt::print(stderr, " {}", run.id);
    fmt::print(stderr, "\n");
    return {};
  }
  std::vector<simulation::Run> runs;
  for (const auto& run : all)
    if (options.only.empty() ? run.by_default : std::ranges::find(options.only, run.id) != options.only.end())
      runs.push_back(run);
  return runs;
}

[[nodiscard]] std::string subtitle_of(const ReportOptions& options, const std::string& name) {
  if (options.real) return fmt::format("Flown by hirosco report {} --real; every figure from real processes.", name);
  std::string text = fmt::format("Flown by hirosco report {} --seed {}", name, options.seed);
  for (const std::string& planted : options.plant) text += " --plant " + planted;
  return text + "; every figure from the whole spacecraft on virtual time.";
}

[[nodiscard]] int verdict(const std::vector<Chapter>& chapters) {
  fmt::print("{}", simulation::verdict_line(chapters));
  return std::ranges::all_of(chapters, &Chapter::holds) ? exit_ok : exit_finding;
}

/// "limits=100" among what is planted: the limits that the manipulator's law keeps to.
[[nodiscard]] int report_corners(const ReportOptions& options, const std::filesystem::path& mission) {
  simulation::CornerSettings settings{.mission = mission, .seed = options.seed};
  constexpr std::string_view limits = "limits=";
  for (const std::string& text : options.plant) {
    char* end = nullptr;
    if (text.starts_with(limits)) settings.planted_limit_n_m = std::strtod(text.c_str() + limits.size(), &end);
    if (end != nullptr && *end == '\0' && settings.planted_limit_n_m > 0) continue;
    fmt::print(stderr, "hirosco report: --corners can be given --plant limits=N_M, for example limits=100\n");
    return exit_usage;
  }
  const simulation::CornerTable table = simulation::fly_corners(settings);
  fmt::print("{}", table.text());
  return table.beyond() == 0 ? exit_ok : exit_finding;
}

}  // namespace

int report(const ReportOptions& options) {
  const std::filesystem::path& mission = options.mission;
  if (options.corners) return report_corners(options, mission);
  const auto table = simulation::ExpectedTable::read(mission.parent_path() / "expected.csv");
  if (!table) {
    fmt::print(stderr, "hirosco report: {}\n", table.error());
    return exit_finding;
  }
  simulation::RunSettings settings{.mission = mission, .seed = options.seed, .repetitions = options.repetitions};
  for (const std::string& text : options.plant) {
    if (plant_one(text, settings.plant)) continue;
    fmt::print(
        stderr,
        "hirosco report: --plant '{}' is not NAME=FACTOR with stiffness, rail, mass, force_scale or hand_clock, nor "
        "delay_ms=MS; for example mass=1.01\n",
        text);
    return exit_usage;
  }
  const auto runs = chosen(options);
  if (runs.empty()) return exit_usage;

  std::vector<Chapter> chapters;
  const auto take = [&](Chapter chapter) {
    chapter.rows = simulation::judged(*table, chapter.id, chapter.findings.figures);
    if (chapter.rows.empty()) chapter.findings.problems.emplace_back("the table expects nothing of this run");
    fmt::print("{}", text_of(chapter));
    std::fflush(stdout);
    chapters.push_back(std::move(chapter));
  };
  if (options.real) {
    take(fly_for_real(mission, options.real_for));
  } else {
    for (const simulation::Run& run : runs) {
      simulation::Findings findings = fly(run, settings);
      findings.notes.push_back(integrated(run, settings, findings.figures, *table, options.convergence));
      take({std::string{run.id}, std::string{run.title}, std::string{run.how}, std::move(findings), {}});
    }
  }
  if (!options.out.empty()) {
    const std::string name = mission.parent_path().filename().string();
    const auto written = write_page(options.out, "Report on mission " + name, subtitle_of(options, name), chapters);
    if (!written) {
      fmt::print(stderr, "hirosco report: {}: {}\n", options.out,
                 std::strerror(static_cast<int>(written.error().value)));
      return exit_environment;
    }
    fmt::print("\nwritten: {}\n", (std::filesystem::path{options.out} / "index.html").string());
  }
  return verdict(chapters);
}

}  // namespace hirosco::rokviss
