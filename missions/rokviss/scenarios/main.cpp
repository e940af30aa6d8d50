// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "missions/rokviss/scenarios/report.hpp"
#include "tools/hirosco/command_line.hpp"
#include "tools/hirosco/commands.hpp"

/// `hirosco-mission-rokviss COMMAND MISSION ...`, as `hirosco COMMAND rokviss ...` calls it.
namespace {

using namespace hirosco;

int read_and_do(int argc, char** argv) {
  CLI::App app{"What the mission rokviss does by itself", "hirosco"};
  app.require_subcommand(1);
  rokviss::ReportOptions options;
  std::string seed = "1";
  std::string real_for = "5min";
  int faults = 0;
  auto* report = app.add_subcommand("report", "Fly the runs that the mission is judged by and compare their figures");
  report->add_option("mission", options.mission, "The mission's file")->required();
  auto* const out = report->add_option("--out", options.out, "Folder for index.html and its plots");
  auto* const seeded = report->add_option("--seed", seed, "Seed of everything random")->capture_default_str();
  auto* const only = report->add_option("--only", options.only, "Only these runs (RO1,RO8)")->delimiter(',');
  auto* const counted = report->add_option("--faults", faults, "Only the fault cases, each so many times")
                            ->check(CLI::Range(1, 100000))
                            ->excludes(only);
  auto* const plant = report->add_option("--plant", options.plant,
                                         "Error of the model that must show: stiffness=1.01, rail=, mass=, "
                                         "force_scale=, hand_clock=, delay_ms=2; of --corners limits=N_M");
  auto* const convergence =
      report->add_flag("--convergence", options.convergence,
                       "Each run a second time with sub-steps half as long: how far its figures move");
  auto* const corners =
      report->add_flag("--corners", options.corners,
                       "Instead every corner of the declared ranges: largest force, torque, speed and the promise");
  auto* const real = report->add_flag("--real", options.real, "On real processes: cycle times and links of a flight");
  report->add_option("--for", real_for, "Length of the real flight")->capture_default_str()->needs(real);
  // What would be left out without a word.
  for (auto* const unused : {out, only, counted, convergence}) corners->excludes(unused);
  for (auto* const unused : {seeded, only, counted, plant, convergence, corners}) real->excludes(unused);
  try {
    app.parse(argc, argv);
    options.seed = tools::seed_of(seed);
    options.real_for = tools::duration_of(real_for);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? tools::exit_ok : tools::exit_usage;
  }
  if (faults > 0) {
    options.only = {"FC"};
    options.repetitions = faults;
  }
  return rokviss::report(options);
}

}  // namespace

int main(int argc, char** argv) {
  return hirosco::tools::run_main("hirosco", [&] { return read_and_do(argc, argv); });
}
