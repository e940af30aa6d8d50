// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "supervisor/platform/process_launcher.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {
namespace {

/// Becomes hirosco-ground; returns only when that cannot be.
[[nodiscard]] int become_station(std::vector<std::string> arguments, const GroundOptions& options) {
  const auto program = supervisor::find_program("hirosco-ground");
  if (program.empty()) {
    fmt::print(stderr, "hirosco: no program hirosco-ground beside this one or in PATH: {}\n", station_needs);
    return exit_environment;
  }
  arguments.insert(arguments.begin(), program.string());
  arguments.insert(arguments.end(), {"--mission", options.mission});
  if (!options.archive.empty()) arguments.insert(arguments.end(), {"--archive", options.archive});
  // Other users see a process's arguments, not its environment.
  if (!options.token.empty()) ::setenv("HIROSCO_GROUND_TOKEN", options.token.c_str(), 1);
  if (!options.observer_token.empty()) ::setenv("HIROSCO_GROUND_OBSERVER_TOKEN", options.observer_token.c_str(), 1);
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  ::execv(words.front(), words.data());
  fmt::print(stderr, "hirosco: {} cannot be started\n", program.string());
  return exit_environment;
}

}  // namespace

int ground(const GroundOptions& options) {
  std::vector<std::string> arguments;
  if (options.port) arguments = {"--port", std::to_string(*options.port)};
  if (!options.telemetry.empty()) arguments.insert(arguments.end(), {"--telemetry", options.telemetry});
  if (!options.page.empty()) arguments.insert(arguments.end(), {"--page", options.page});
  if (options.json) arguments.emplace_back("--json");
  return become_station(std::move(arguments), options);
}

int why(const GroundOptions& options) {
  std::vector<std::string> arguments{"--why"};
  if (options.json) arguments.emplace_back("--json");
  return become_station(std::move(arguments), options);
}

}  // namespace hirosco::tools
