// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/packet/failure_code.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <string>

namespace hirosco::pus {
namespace {

using CodeWords = std::map<unsigned long, std::string>;

[[nodiscard]] std::ifstream source_file(const std::string& path) {
  std::ifstream file{std::string{HIROSCO_SOURCE_DIR} + "/" + path};
  EXPECT_TRUE(file) << path;
  return file;
}

/// Of each code that has one.
[[nodiscard]] CodeWords words_of_the_codes() {
  CodeWords words;
  for (const auto& row : EnumTexts<FailureCode>::table)
    words.emplace(static_cast<unsigned long>(row.value), std::string{row.text});
  return words;
}

TEST(FailureCodes, EachHasWords) {
  const CodeWords words = words_of_the_codes();
  std::ifstream header = source_file("hirosco/pus/packet/failure_code.hpp");
  const std::regex enumerator{R"(  ([A-Z]\w+) = (\d\w*),)"};
  std::size_t declared = 0;
  std::smatch found;
  for (std::string line; std::getline(header, line);) {
    if (!std::regex_match(line, found, enumerator)) continue;
    ++declared;
    EXPECT_TRUE(words.contains(std::stoul(found[2], nullptr, 0))) << found[1] << " has no words in EnumTexts";
  }
  EXPECT_EQ(declared, words.size());
}

/// Who gets a code looks it up there: each has one row, under the words that every program says for it.
TEST(FailureCodes, AreTheRowsInTheDocuments) {
  std::ifstream page = source_file("docs/failure-codes.md");
  const std::regex row{R"(\| (\d\w*) \| ([^|]+) \| ([^|]+) \| ([^|]+) \| ([^|]+) \|)"};
  CodeWords rows;
  std::smatch found;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| ") || line.starts_with("| code ")) continue;
    ASSERT_TRUE(std::regex_match(line, found, row)) << "not | code | name | who | data | what to do |: " << line;
    EXPECT_TRUE(rows.emplace(std::stoul(found[1], nullptr, 0), found[2]).second) << found[1] << " stands twice";
  }
  EXPECT_EQ(rows, words_of_the_codes());
}

}  // namespace
}  // namespace hirosco::pus
