// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "missions/servicer/scenarios/report.hpp"
#include "tools/hirosco/command_line.hpp"
#include "tools/hirosco/commands.hpp"

/// `hirosco-mission-servicer COMMAND MISSION ...`, as `hirosco COMMAND servicer ...` calls it.
namespace {

using namespace hirosco;

int read_and_do(int argc, char** argv) {
  CLI::App app{"What the mission servicer does by itself", "hirosco"};
  app.require_subcommand(1);
  servicer::ReportOptions options;
  std::string seed = "1";
  auto* report = app.add_subcommand("report", "Fly the runs that the mission is judged by and compare their figures");
  report->add_option("mission", options.mission, "The mission's file")->required();
  report->add_option("--out", options.out, "Folder for index.html and its plots");
  report->add_option("--seed", seed, "Seed of everything random")->capture_default_str();
  report->add_option("--only", options.only, "Only these runs (SV1,SV8)")->delimiter(',');
  try {
    app.parse(argc, argv);
    options.seed = tools::seed_of(seed);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? tools::exit_ok : tools::exit_usage;
  }
  return servicer::report(options);
}

}  // namespace

int main(int argc, char** argv) {
  return hirosco::tools::run_main("hirosco", [&] { return read_and_do(argc, argv); });
}
