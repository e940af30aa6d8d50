// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"

/// Shared by the tests of this folder.
namespace hirosco::descriptor::testing {

inline const std::filesystem::path data = std::filesystem::path{HIROSCO_SOURCE_DIR} / "hirosco/descriptor/testdata";

inline FileSource text_source(std::string text) {
  return [text = std::move(text)](const std::filesystem::path&) -> Result<std::string> { return text; };
}

inline Reading<SubsystemDescriptor> read_text(const std::string& text) {
  return read_subsystem("test.xml", text_source(text));
}

inline std::string rendered(const std::vector<Diagnostic>& problems, const FileSource& source) {
  std::string all;
  for (const Diagnostic& problem : problems) all += problem.code + " " + render(problem, source, false);
  return all;
}

/// A text in which '@' marks where the problem is expected.
struct Marked {
  std::string text;
  Location at;
};
inline Marked marked(const std::string& text) {
  const std::size_t mark = text.find('@');
  Marked result{text, {1, 1}};
  for (std::size_t i = 0; i < mark && i < text.size(); ++i) {
    ++result.at.column;
    if (text[i] == '\n') result.at = {result.at.line + 1, 1};
  }
  if (mark != std::string::npos) result.text.erase(mark, 1);
  return result;
}

/// Files in memory; what is not there is read from the test data.
inline FileSource overlay(std::map<std::string, std::string> files) {
  return [files = std::move(files)](const std::filesystem::path& file) -> Result<std::string> {
    const auto found = files.find(file.filename().string());
    return found == files.end() ? file_system()(file) : found->second;
  };
}

inline std::string good_mission() { return file_system()(data / "mission.xml").value(); }

/// The good mission with the first `from` replaced.
inline std::string changed(const std::string& from, const std::string& to, std::string text = good_mission()) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace hirosco::descriptor::testing
