// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

/// The tables of docs/interfaces that are marked `octets` or `numbers`.
namespace hirosco {

using Row = std::vector<std::string>;
using Table = std::vector<Row>;
using Place = std::map<std::string, std::pair<std::size_t, std::size_t>>;  ///< name: where, how many octets

[[nodiscard]] inline std::string trimmed(std::string text) {
  const auto begin = text.find_first_not_of(" `");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" `") - begin + 1);
}

[[nodiscard]] inline Row cells_of(const std::string& line) {
  Row cells;
  std::stringstream rest{line.substr(1)};
  for (std::string cell; std::getline(rest, cell, '|');) cells.push_back(trimmed(cell));
  return cells;
}

/// By mark, "octets: vital page": the rows of the table behind it.
[[nodiscard]] inline const std::map<std::string, Table>& tables() {
  static const auto all = [] {
    std::map<std::string, Table> found;
    for (const auto& page :
         std::filesystem::directory_iterator{std::filesystem::path{HIROSCO_SOURCE_DIR} / "docs/interfaces"}) {
      std::ifstream file{page.path()};
      std::string mark;
      int head = 0;
      for (std::string line; std::getline(file, line);) {
        if (line.starts_with("<!-- octets: ") || line.starts_with("<!-- numbers: ")) {
          mark = line.substr(5, line.size() - 9);
          EXPECT_FALSE(found.contains(mark)) << mark << " stands twice";
          found[mark];
          head = 2;
        } else if (!line.starts_with("|")) mark.clear();
        else if (!mark.empty() && head-- <= 0) found[mark].push_back(cells_of(line));
      }
    }
    return found;
  }();
  return all;
}

[[nodiscard]] inline std::uint64_t number_of(const std::string& text) { return std::stoull(text, nullptr, 0); }

/// Marks that a test has looked at.
inline std::vector<std::string>& compared() {
  static std::vector<std::string> marks;
  return marks;
}

[[nodiscard]] inline const Table& table(const std::string& mark) {
  compared().push_back(mark);
  const auto found = tables().find(mark);
  EXPECT_NE(found, tables().end()) << mark;
  static const Table none;
  return found == tables().end() ? none : found->second;
}

inline void expect_octets(const std::string& mark, const Place& code) {
  Place page;
  for (const Row& row : table("octets: " + mark)) page[row.at(2)] = {number_of(row[0]), number_of(row[1])};
  EXPECT_EQ(page, code) << mark;
}

inline void expect_numbers(const std::string& mark, std::map<std::uint64_t, std::string> code) {
  std::map<std::uint64_t, std::string> page;
  for (const Row& row : table("numbers: " + mark)) page[number_of(row.at(0))] = row.at(1);
  EXPECT_EQ(page, code) << mark;
}

}  // namespace hirosco
