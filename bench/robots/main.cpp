// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/robots/arm_cycles.hpp"
#include "bench/robots/robot_cases.hpp"
#include "tools/hirosco/command_line.hpp"
#include "tools/hirosco/commands.hpp"

/// `hirosco-robot-cases MISSION`: how exactly the arm of a folder that `hirosco new robot` made goes where it is told to, or what its cycles take.
namespace {

using namespace hirosco;

int fly(const std::string& mission, const std::vector<int>& only, std::uint64_t seed) {
  const auto task = bench::robot_task(mission);
  if (!task) {
    fmt::print(stderr, "hirosco-robot-cases: {}: {}\n", mission, task.error());
    return tools::exit_finding;
  }
  fmt::print("{}: {} joints, tool {}, {} goals and {} lines there and back\n", task->subsystem, task->joints.size(),
             task->tip, task->goals.size(), task->lines.size());
  fmt::print("  {:<40} {:>16} {:>15} {:>21}\n", "", "at goals, mrad", "tool, mm", "beside its line, mm");
  fmt::print(
      "  {:<40} {:>16} {:>15} {:>21}\n", "as required", fmt::format("<= {:g}", 1e3 * bench::most_joint_error_rad),
      fmt::format("<= {:g}", 1e3 * bench::most_tool_error_m), fmt::format("<= {:g}", 1e3 * bench::most_beside_line_m));
  bool all = true;
  const auto cases = bench::robot_cases(task->weakest);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!only.empty() && std::ranges::find(only, static_cast<int>(i) + 1) == only.end()) continue;
    const auto found = bench::fly_case(mission, *task, cases[i], seed);
    fmt::print("  {:<40} {:>16.3f} {:>15.3f} {:>21.3f}{}\n", cases[i].name,
               1e3 * std::max(found.joint_rad, found.turned_rad), 1e3 * found.tool_m, 1e3 * found.beside_m,
               found.holds() ? "" : "  not as required");
    if (!found.problems.empty())
      fmt::print("    after {} goals and {} lines: {}\n", found.goals, found.lines,
                 fmt::join(found.problems, "\n      "));
    std::fflush(stdout);
    all = all && found.holds();
  }
  return all ? tools::exit_ok : tools::exit_finding;
}

/// One line, for whoever tries many.
int fly_first(const std::string& mission, std::uint64_t seed) {
  const auto task = bench::first_task(mission);
  if (!task) {
    fmt::print(stderr, "hirosco-robot-cases: {}: {}\n", mission, task.error());
    return tools::exit_finding;
  }
  const auto found = bench::fly_case(mission, *task, bench::robot_cases(task->weakest).front(), seed);
  fmt::print("{} of {} goals, joints {:.3f} mrad or mm off, tool {:.3f} mm{}{}\n", found.goals, task->goals.size(),
             1e3 * found.joint_rad, 1e3 * found.tool_m, found.problems.empty() ? "" : ": ",
             fmt::join(found.problems, "; "));
  return found.reaches_goals() ? tools::exit_ok : tools::exit_finding;
}

/// Beside what is required, of so many cycles in motion.
int measure(const std::string& mission, std::size_t cycles, std::uint64_t seed) {
  const auto task = bench::robot_task(mission);
  if (!task) {
    fmt::print(stderr, "hirosco-robot-cases: {}: {}\n", mission, task.error());
    return tools::exit_finding;
  }
  const auto found = bench::measure_arm_cycles(mission, *task, cycles, seed);
  fmt::print("{}: {} joints, a cycle each {:g} us, {} of them in motion; us\n", task->subsystem, task->joints.size(),
             found.period_us, found.processor_ns.size());
  const auto line = [](const char* what, const bench::Figures& its) {
    fmt::print("  {:<28} median {:>8.1f}   p99 {:>8.1f}   worst {:>8.1f}\n", what, its.p50, its.p99, its.max);
  };
  line("used of the processor", found.processor());
  line("passed meanwhile", found.wall());
  fmt::print("  {:<28} {:.1f} %   as required <= {:g} %{}\n", "p99 of the period", 1e2 * found.share(),
             1e2 * bench::most_of_a_period, found.share() <= bench::most_of_a_period ? "" : "  not as required");
  fmt::print("  with inverse dynamics, observer (up to {:.2g} N m or N), collision check (no nearer than {:.0f} mm)\n",
             found.most_external, 1e3 * found.least_clearance_m);
  for (const auto& each : found.missing()) fmt::print("    not measured as required: {}\n", each);
  if (!found.problems.empty()) fmt::print("    {}\n", fmt::join(found.problems, "\n    "));
  return found.holds() ? tools::exit_ok : tools::exit_finding;
}

int read_and_fly(int argc, char** argv) {
  CLI::App app{"Flies the arm of a mission on virtual time, in a world that differs from its URDF file",
               "hirosco-robot-cases"};
  std::string mission, seed = "1";
  std::vector<int> only;
  bool first = false;
  std::size_t cycles = 0;
  app.add_option("mission", mission, "mission.xml of a folder that `hirosco new robot` made")->required();
  app.add_option("--only", only, "Only these cases, from 1 (1,6)")->delimiter(',')->check(CLI::Range(1, 6));
  app.add_flag("--first", first, "Only to the goal of its README and back: any robot, in one line");
  app.add_option("--cycles", cycles,
                 "What its cycles take beside a tenth of their period, of at least so many in motion")
      ->check(CLI::Range(1'000, 100'000'000));
  app.add_option("--seed", seed, "Seed of everything random")->capture_default_str();
  std::uint64_t number = 1;
  try {
    app.parse(argc, argv);
    number = tools::seed_of(seed);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? tools::exit_ok : tools::exit_usage;
  }
  if (cycles > 0) return measure(mission, cycles, number);
  return first ? fly_first(mission, number) : fly(mission, only, number);
}

}  // namespace

int main(int argc, char** argv) {
  return hirosco::tools::run_main("hirosco-robot-cases", [&] { return read_and_fly(argc, argv); });
}
