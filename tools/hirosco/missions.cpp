// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <fstream>
#include <set>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/utilities/nearest.hpp"
#include "hirosco/utilities/os/installation.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/permits.hpp"

namespace hirosco::tools {

namespace fs = std::filesystem;

namespace {

/// Folders that may hold `missions/`: from the working directory upwards, and where what comes with this program is.
[[nodiscard]] std::vector<fs::path> mission_roots() {
  std::error_code failed;
  std::vector<fs::path> roots;
  for (fs::path folder = fs::current_path(failed);; folder = folder.parent_path()) {
    roots.push_back(folder);
    if (!folder.has_relative_path()) break;
  }
  for (fs::path& folder : shipped_folders()) roots.push_back(std::move(folder));
  return roots;
}

}  // namespace

std::vector<std::string> known_missions() {
  std::set<std::string> names;
  std::error_code failed;
  for (const fs::path& root : mission_roots())
    for (const auto& entry : fs::directory_iterator{root / "missions", failed})
      if (fs::is_regular_file(entry.path() / "mission.xml", failed)) names.insert(entry.path().filename().string());
  return {names.begin(), names.end()};
}

std::string document(const std::string& name) {
  std::error_code failed;
  for (const fs::path& folder : shipped_folders()) {
    const fs::path installed = folder.parent_path() / "doc/hirosco" / name;
    if (fs::is_regular_file(installed, failed)) return installed.string();
    if (fs::is_regular_file(folder / "docs" / name, failed)) return "docs/" + name;
  }
  return name + " of the package hirosco-doc";
}

std::string did_you_mean(std::string_view text, const std::vector<std::string>& names) {
  const std::vector<std::string_view> candidates{names.begin(), names.end()};
  const std::string_view found = nearest(text, candidates);
  return found.empty() ? std::string{} : fmt::format("; did you mean '{}'?", found);
}

fs::path find_mission(const std::string& name_or_path) {
  std::error_code failed;
  fs::path given{name_or_path};
  if (fs::is_regular_file(given, failed)) return given;
  if (fs::is_regular_file(given / "mission.xml", failed)) return given / "mission.xml";
  if (name_or_path.find('/') != std::string::npos) return {};
  for (const fs::path& root : mission_roots()) {
    const fs::path candidate = root / "missions" / name_or_path / "mission.xml";
    if (fs::is_regular_file(candidate, failed)) return candidate;
  }
  return {};
}

std::string usual_mission() {
  for (const fs::path& root : mission_roots()) {
    std::ifstream file{root / "missions" / "usual"};
    for (std::string line; std::getline(file, line);)
      if (!line.empty() && line[0] != '#') return line;
  }
  return {};
}

std::string meant_mission() {
  std::error_code failed;
  if (fs::is_regular_file("mission.xml", failed)) return "mission.xml";
  std::set<std::string> flown;
  for (const auto& entry : fs::directory_iterator{"log", failed}) {
    const fs::path& path = entry.path();
    const bool is_log = path.extension() == ".db" || path.extension() == ".log";
    if (is_log && !find_mission(path.stem().string()).empty()) flown.insert(path.stem().string());
  }
  return flown.size() == 1 ? *flown.begin() : std::string{};
}

std::optional<descriptor::Mission> load_mission(const std::string& name_or_path) {
  const fs::path file = find_mission(name_or_path);
  if (file.empty()) {
    const auto known = known_missions();
    fmt::print(
        stderr,
        "hirosco: no mission '{}': neither a file nor missions/{}/mission.xml here, above, or with this program{}\n",
        name_or_path, name_or_path, did_you_mean(name_or_path, known));
    if (!known.empty()) fmt::print(stderr, "there are: {}\n", fmt::join(known, ", "));
    return std::nullopt;
  }
  const auto source = descriptor::file_system();
  auto reading = descriptor::read_mission(file, source);
  const bool colour = ::isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
  if (reading.value) reading.problems = permit_problems(*reading.value);
  for (const auto& problem : reading.problems) fmt::print(stderr, "{}", descriptor::render(problem, source, colour));
  return reading.problems.empty() ? std::move(reading.value) : std::nullopt;
}

fs::path runtime_root() {
  const char* base = std::getenv("XDG_RUNTIME_DIR");
  return base != nullptr && *base != '\0' ? fs::path{base} : fs::temp_directory_path();
}

std::uint16_t port_of(const std::string& address) {
  std::uint16_t port = 0;
  const std::size_t digits = address.rfind(':') + 1;
  std::from_chars(address.data() + digits, address.data() + address.size(), port);
  return port;
}

std::uint16_t telecommand_port(const descriptor::Mission& mission, std::uint16_t telemetry_port) {
  return static_cast<std::uint16_t>(telemetry_port + port_of(mission.ground.telecommand) -
                                    port_of(mission.ground.telemetry));
}

fs::path runtime_folder(const std::string& instance) {
  return runtime_root() / (fmt::format("hirosco-{}-", ::getuid()) + instance);
}

fs::path archive_beside(const fs::path& log) { return log.parent_path() / (log.stem().string() + "-ground.db"); }

std::string instance_of_folder(const fs::path& folder) {
  const std::string name = folder.filename().string();
  const std::string begin = fmt::format("hirosco-{}-", ::getuid());
  return name.starts_with(begin) ? name.substr(begin.size()) : std::string{};
}

}  // namespace hirosco::tools
