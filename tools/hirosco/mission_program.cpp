// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "hirosco/utilities/os/installation.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {

int mission_program(const std::string& command, const std::string& name, const std::vector<std::string>& rest) {
  const auto mission = load_mission(name);
  if (!mission) return exit_finding;
  std::string program = "hirosco-mission-";
  for (const char letter : mission->name)
    program += letter == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  const std::string file = find_program(program).string();
  if (file.empty()) {
    fmt::print(stderr, "hirosco {}: mission {} has nothing of this kind: no program {} beside this one or in PATH\n",
               command, mission->name, program);
    return exit_finding;
  }
  std::vector<std::string> words{file, command, mission->file.string()};
  words.insert(words.end(), rest.begin(), rest.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(file.c_str(), arguments.data());
  fmt::print(stderr, "hirosco {}: {}: {}\n", command, file, std::strerror(errno));
  return exit_environment;
}

}  // namespace hirosco::tools
