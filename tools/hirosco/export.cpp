// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>

#include "ground/clients/python/python_package.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {

int export_python(const ExportOptions& options) {
  auto mission = load_mission(options.mission);
  if (!mission) return exit_finding;
  const ground::Catalogue catalogue{std::move(*mission)};
  const auto package = ground::python_package(catalogue);
  const std::filesystem::path folder = std::filesystem::path{options.to} / package.name;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  for (const auto& [name, text] : package.files) {
    std::ofstream file{folder / name, std::ios::binary | std::ios::trunc};
    file << text;
    if (!file.flush()) {
      fmt::print(stderr, "hirosco export: {} cannot be written\n", (folder / name).string());
      return exit_environment;
    }
    fmt::print("wrote {}\n", (folder / name).string());
  }
  std::string names;
  for (const auto* subsystem : catalogue.subsystems()) names += (names.empty() ? "" : ", ") + subsystem->name;
  fmt::print(
      "{} of the mission {}: {}. To use it while the mission flies:\n\n"
      "    PYTHONPATH={} python3\n"
      "    >>> from {} import Spacecraft\n"
      "    >>> craft = Spacecraft()\n"
      "    >>> help(craft)\n\n"
      "docs/guide/python_client.md says the rest.\n",
      catalogue.subsystems().size() == 1 ? "The subsystem" : "The subsystems", catalogue.mission().name, names,
      options.to, package.name);
  return exit_ok;
}

}  // namespace hirosco::tools
