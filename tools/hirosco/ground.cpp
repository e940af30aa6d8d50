// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "hirosco/utilities/os/installation.hpp"
#include "supervisor/platform/storage/log_pieces.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/instance.hpp"

namespace hirosco::tools {
namespace {

/// Becomes hirosco-ground; returns only when that cannot be.
[[nodiscard]] int become_station(std::vector<std::string> arguments, const std::filesystem::path& mission,
                                 const GroundOptions& options) {
  const auto program = find_program("hirosco-ground");
  if (program.empty()) {
    fmt::print(stderr, "hirosco: no program hirosco-ground beside this one or in PATH: {}\n", station_needs);
    return exit_environment;
  }
  arguments.insert(arguments.begin(), program.string());
  arguments.insert(arguments.end(), {"--mission", mission.string()});
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
  // Who says where the spacecraft is gets exactly that, whatever flies on this computer.
  const bool said = !options.telemetry.empty() && options.instance.empty();
  auto found =
      said ? only_mission("ground", options.mission) : find_flight("ground", options.mission, options.instance);
  if (!found) return found.error();
  const descriptor::Mission& mission = found->mission;
  std::vector<std::string> arguments;
  if (options.port) arguments = {"--port", std::to_string(*options.port)};
  std::string telemetry = options.telemetry;
  std::filesystem::path archive = options.archive;
  if (found->flight) {
    const FlightEntry& flight = *found->flight;
    if (telemetry.empty()) telemetry = flight.telemetry;
    // In the folder that the station is started in, as for one that waits for its flight.
    if (archive.empty() && flight.named()) archive = archive_beside(instance_log(mission, flight.instance));
    arguments.insert(arguments.end(), {"--devices", flight.folder.string()});
  }
  if (!telemetry.empty()) arguments.insert(arguments.end(), {"--telemetry", telemetry});
  if (!archive.empty()) arguments.insert(arguments.end(), {"--archive", archive.string()});
  if (!options.page.empty()) arguments.insert(arguments.end(), {"--page", options.page});
  if (options.json) arguments.emplace_back("--json");
  return become_station(std::move(arguments), mission.file, options);
}

int why(const GroundOptions& options) {
  std::vector<std::string> arguments{"--why"};
  if (options.json) arguments.emplace_back("--json");
  if (options.markdown) arguments.emplace_back("--md");
  if (!options.archive.empty()) {
    const auto found = only_mission("why", options.mission);
    if (!found) return found.error();
    arguments.insert(arguments.end(), {"--archive", options.archive});
    return become_station(std::move(arguments), found->mission.file, options);
  }
  const auto found = find_log("why", options.mission, options.instance);
  if (!found) return found.error();
  if (!found->path.empty()) arguments.insert(arguments.end(), {"--archive", archive_beside(found->path).string()});
  // Whether the archive has something of the newest flight is seen by when its log began.
  if (const auto newest = supervisor::read_log(found->path, {.last = 1}); newest && !newest->records.empty())
    arguments.insert(arguments.end(),
                     {"--flown", std::to_string(newest->records.back().run.time_since_epoch().count())});
  return become_station(std::move(arguments), found->mission.file, options);
}

}  // namespace hirosco::tools
