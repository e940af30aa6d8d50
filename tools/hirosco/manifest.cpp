// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/utilities/os/installation.hpp"
#include "supervisor/platform/launch/program_image.hpp"
#include "tools/hirosco/commands.hpp"

/// `hirosco manifest`: the digests of what is here, as a mission's manifest has them (docs/adr/0089).
namespace hirosco::tools {
namespace {

namespace fs = std::filesystem;

/// A manifest that is not there yet, or is to be made anew, keeps nobody from reading the mission.
[[nodiscard]] descriptor::FileSource without_manifest() {
  return [all = descriptor::file_system()](const fs::path& file) -> Result<std::string> {
    if (file.extension() == descriptor::manifest_extension) return std::string{};
    return all(file);
  };
}

/// Files by name: the program itself, and its versions beside it.
[[nodiscard]] std::map<std::string, fs::path> files_of(const std::string& program) {
  const fs::path file = find_program(program);
  if (file.empty()) return {};
  std::map<std::string, fs::path> files{{program, file}};
  std::error_code failed;
  const std::string head = program + descriptor::version_mark;
  for (const auto& entry : fs::directory_iterator{file.parent_path(), failed})
    if (const std::string name = entry.path().filename().string();
        name.starts_with(head) && descriptor::is_version(std::string_view{name}.substr(head.size())))
      files.emplace(name, entry.path());
  return files;
}

/// Empty: one cannot be read, which was said.
[[nodiscard]] std::string lines_of(const descriptor::Mission& mission) {
  std::map<std::string, fs::path> files;
  for (const auto& member : mission.subsystems) {
    auto found = files_of(member.executable);
    if (found.empty()) {
      fmt::print(stderr, "hirosco manifest: no program {} for {}: it is neither beside this program nor in PATH\n",
                 member.executable, member.subsystem.name);
      return {};
    }
    files.merge(found);
  }
  std::string lines;
  for (const auto& [name, file] : files) {
    const auto image = supervisor::ProgramImage::read(file);
    if (!image) {
      fmt::print(stderr, "hirosco manifest: {}: {}\n", file.string(), image.error().text);
      return {};
    }
    lines += fmt::format("{}  {}\n", image->digest(), name);
  }
  return lines;
}

/// Whole or not at all: a flight may begin meanwhile.
[[nodiscard]] bool write(const fs::path& file, const std::string& text) {
  auto beside = file;
  beside += ".new";
  {
    std::ofstream stream{beside, std::ios::binary};
    if (!(stream << text) || !stream.flush()) return false;
  }
  std::error_code failed;
  fs::rename(beside, file, failed);
  return !failed;
}

}  // namespace

int manifest(const ManifestOptions& options) {
  const auto file = find_mission(options.mission);
  const auto source = without_manifest();
  const auto reading = descriptor::read_mission(file.empty() ? fs::path{options.mission} : file, source);
  for (const auto& problem : reading.problems) fmt::print(stderr, "{}", descriptor::render(problem, source, false));
  if (!reading.value) return exit_finding;
  const descriptor::Mission& mission = *reading.value;
  if (options.write && !mission.manifest) {
    fmt::print(stderr, "hirosco manifest: {} has no manifest: put <Manifest path=\"manifest{}\"/> into it\n",
               mission.file.string(), descriptor::manifest_extension);
    return exit_usage;
  }
  const std::string lines = lines_of(mission);
  if (lines.empty()) return exit_finding;
  if (!options.write) {
    fmt::print("{}", lines);
    return exit_ok;
  }
  const auto count = std::ranges::count(lines, '\n');
  if (!write(mission.manifest->file, lines)) {
    fmt::print(stderr, "hirosco manifest: {} cannot be written\n", mission.manifest->file.string());
    return exit_environment;
  }
  fmt::print("{}: {} executable{}\n", mission.manifest->file.string(), count, count == 1 ? "" : "s");
  return exit_ok;
}

}  // namespace hirosco::tools
