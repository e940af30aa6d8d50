// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/robot_world.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

#include "tools/new_folder/kinds.hpp"

namespace hirosco::tools {

RobotWorld robot_world(const std::filesystem::path& templates) {
  const auto kind = std::ranges::find_if(new_kinds(), &NewKind::of_urdf);
  if (kind == new_kinds().end()) return {};
  std::ifstream file{templates / kind->name / "mission.xml"};
  const std::string mission{std::istreambuf_iterator<char>{file}, {}};
  // A template is no XML before its words are replaced.
  static const std::regex device{R"re(<SimulatedDevice\b[^>]*\bexecutable="(hirosco-sim-([\w-]+))")re"};
  std::smatch found;
  if (!std::regex_search(mission, found, device)) return {};
  const std::string word = found[2];
  return {.program = found[1],
          .word = word,
          .package = "hirosco-world-" + word,
          .fetcher = "fetch_" + word,
          .library = "lib" + word + ".so."};
}

}  // namespace hirosco::tools
