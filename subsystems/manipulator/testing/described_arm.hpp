// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "hirosco/descriptor/read/read.hpp"

/// Arms of any number of joints, for tests: what differs between them is their descriptor.
namespace hirosco::manipulator::testing {

/// So many joints differ from each other; behind them it begins anew, within their limits.
inline constexpr std::size_t different = 7;
/// Where a joint, from 0, is at home.
[[nodiscard]] constexpr double home_rad(std::size_t joint) noexcept {
  return 0.1 * static_cast<double>(joint % different + 1);
}

/// testdata/arm.xml with another number of joints.
[[nodiscard]] inline std::string described_arm(std::size_t joints) {
  std::string text = descriptor::file_system()(HIROSCO_SOURCE_DIR "/subsystems/manipulator/testdata/arm.xml").value();
  const auto replace_all = [&text](const std::string& from, const std::string& to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  std::string home, safe;
  for (std::size_t i = 1; i <= joints; ++i) {
    home += " 0." + std::to_string((i - 1) % different + 1);
    safe += " 0";
  }
  replace_all("0.1 0.2 0.3 0.4 0.5 0.6", home.substr(1));
  replace_all("0 0 0 0 0 0", safe.substr(1));
  replace_all("count=\"6\"", "count=\"" + std::to_string(joints) + "\"");
  const auto line_of = [&text](std::size_t joint) {
    const auto begin = text.find("      <Argument name=\"Q" + std::to_string(joint) + "\"");
    return std::pair{begin, text.find('\n', begin) + 1 - begin};
  };
  for (std::size_t joint = 6; joint > joints; --joint) text.erase(line_of(joint).first, line_of(joint).second);
  for (std::size_t joint = 7; joint <= joints; ++joint) {
    const auto [begin, length] = line_of(joint - 1);
    std::string line = text.substr(begin, length);
    line.replace(line.find('Q') + 1, std::to_string(joint - 1).size(), std::to_string(joint));
    text.insert(begin + length, line);
  }
  return text;
}

}  // namespace hirosco::manipulator::testing
