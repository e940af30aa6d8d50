// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>
#include <map>

#include "ground/clients/icd/icd.hpp"
#include "ground/clients/python/python_package.hpp"
#include "ground/clients/xtce/xtce.hpp"
#include "ground/clients/yamcs/yamcs_project.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {
namespace {

/// Texts by their file names below `folder`. Not all could be written: said on standard error, false.
[[nodiscard]] bool write_files(const std::filesystem::path& folder, const std::map<std::string, std::string>& files) {
  for (const auto& [name, text] : files) {
    const std::filesystem::path path = folder / name;
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    std::ofstream file{path, std::ios::binary | std::ios::trunc};
    file << text;
    if (!file.flush()) {
      fmt::print(stderr, "hirosco export: {} cannot be written\n", path.string());
      return false;
    }
    fmt::print("wrote {}\n", path.string());
  }
  return true;
}

void explain_python(const ground::Catalogue& catalogue, const std::string& package, const std::string& to) {
  std::string names;
  for (const auto* subsystem : catalogue.subsystems()) names += (names.empty() ? "" : ", ") + subsystem->name;
  fmt::print(
      "{} of the mission {}: {}. To use it while the mission flies:\n\n"
      "    PYTHONPATH={} python3\n"
      "    >>> from {} import Spacecraft\n"
      "    >>> craft = Spacecraft()\n"
      "    >>> help(craft)\n\n"
      "{} says the rest.\n",
      catalogue.subsystems().size() == 1 ? "The subsystem" : "The subsystems", catalogue.mission().name, names, to,
      package, document("guide/python_client.md"));
}

}  // namespace

int export_mission(const ExportOptions& options) {
  auto mission = load_mission(options.mission);
  if (!mission) return exit_finding;
  const ground::Catalogue catalogue{std::move(*mission)};
  const std::filesystem::path to{options.to};
  switch (options.what) {
    case Exported::Python: {
      const auto package = ground::python_package(catalogue);
      if (!write_files(to / package.name, package.files)) return exit_environment;
      explain_python(catalogue, package.name, options.to);
      return exit_ok;
    }
    case Exported::Xtce: {
      const auto database = ground::xtce(catalogue);
      return write_files(to, {{database.name + ".xml", database.text}}) ? exit_ok : exit_environment;
    }
    case Exported::Yamcs: {
      const auto project = ground::yamcs_project(catalogue);
      if (!write_files(to / project.name, project.files)) return exit_environment;
      fmt::print("{} says how to start it.\n", (to / project.name / "README.md").string());
      return exit_ok;
    }
    case Exported::InterfaceDocument: {
      const std::string name = ground::XtceNames{}.unique(catalogue.mission().name) + "-icd.md";
      return write_files(to, {{name, ground::interface_document(catalogue)}}) ? exit_ok : exit_environment;
    }
  }
  return exit_internal;
}

}  // namespace hirosco::tools
