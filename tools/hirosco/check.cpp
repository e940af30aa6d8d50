// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "hirosco/descriptor/read.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {
namespace {

[[nodiscard]] bool is_mission(const std::string& text) {
  const auto mission = text.find("<Mission");
  const auto subsystem = text.find("<Subsystem");
  return mission != std::string::npos && (subsystem == std::string::npos || mission < subsystem);
}

void show_subsystem(const descriptor::Subsystem& subsystem) {
  fmt::print("subsystem {} (APID {}): {} parameters, {} functions, {} events\n", subsystem.name, subsystem.id,
             subsystem.parameters.size(), subsystem.functions.size(), subsystem.events.size());
  for (const auto& configuration : subsystem.configurations)
    fmt::print("  configuration {} ({}): {} us, priority {}, provides {}, requires {}, devices {}, structures {}\n",
               configuration.name, configuration.id, configuration.sampling / 1us, configuration.priority,
               configuration.provides.size(), configuration.requires_.size(), configuration.devices.size(),
               configuration.housekeeping.size() + subsystem.housekeeping.size());
}

void show_mission(const descriptor::Mission& mission) {
  fmt::print("mission {} ({})\n", mission.name, mission.id);
  show_subsystem(mission.supervisor);
  for (const auto& member : mission.subsystems) show_subsystem(member.subsystem);
  for (const auto& link : mission.links)
    fmt::print("link {}: {}.{} -> {}.{}\n", link.id, link.from, link.provides, link.to, link.requires_);
  for (const auto& mode : mission.modes) fmt::print("mode {} ({})\n", mode.name, mode.id);
}

}  // namespace

int check(const CheckOptions& options) {
  const auto source = descriptor::file_system();
  const bool colour = ::isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
  std::size_t problems = 0;
  for (const std::string& name : options.files) {
    const auto file = find_mission(name);
    const auto text = source(file.empty() ? std::filesystem::path{name} : file);
    if (!text) {
      fmt::print(stderr, "hirosco check: cannot read {}\n", name);
      return exit_environment;
    }
    std::vector<descriptor::Diagnostic> found;
    if (is_mission(*text)) {
      auto reading = descriptor::read_mission(file.empty() ? std::filesystem::path{name} : file, source);
      if (options.show && reading.value) show_mission(*reading.value);
      found = std::move(reading.problems);
    } else {
      auto reading = descriptor::read_subsystem(name, source);
      if (options.show && reading.value) show_subsystem(*reading.value);
      found = std::move(reading.problems);
    }
    for (const auto& problem : found) {
      if (options.json)
        fmt::print("{{\"file\":\"{}\",\"line\":{},\"column\":{},\"code\":\"{}\",\"message\":\"{}\",\"hint\":\"{}\"}}\n",
                   json_text(problem.file.string()), problem.at.line, problem.at.column, problem.code,
                   json_text(problem.message), json_text(problem.hint));
      else fmt::print(stderr, "{}", descriptor::render(problem, source, colour));
    }
    problems += found.size();
  }
  if (problems == 0) return exit_ok;
  if (!options.json)
    fmt::print(stderr, "{} error{}; codes are explained in docs/descriptor-errors.md\n", problems,
               problems == 1 ? "" : "s");
  return exit_finding;
}

}  // namespace hirosco::tools
