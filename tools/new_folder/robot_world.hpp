// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace hirosco::tools {

/// The world in which robots of URDF files fly, which is a program that nobody knows by name but the template of such a robot
/// (docs/adr/0224). What belongs to it is called by its word, the last one of hirosco-sim-WORD; its physics is fetched, not packaged
/// (docs/adr/0129). All empty: there is no template here.
struct RobotWorld {
  std::string program;  ///< hirosco-sim-WORD
  std::string word;
  std::string package;  ///< hirosco-world-WORD
  std::string fetcher;  ///< fetch_WORD, which gets the library
  std::string library;  ///< libWORD.so., the beginning of its name
};

/// As the mission of that template says, in the folder of all templates.
[[nodiscard]] RobotWorld robot_world(const std::filesystem::path& templates);

}  // namespace hirosco::tools
