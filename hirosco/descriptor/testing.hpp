// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/descriptor/read.hpp"

/// Shared by the tests of this folder.
namespace hirosco::descriptor::testing {

inline const std::filesystem::path data = std::filesystem::path{HIROSCO_SOURCE_DIR} / "hirosco/descriptor/testdata";

inline FileSource text_source(std::string text) {
  return [text = std::move(text)](const std::filesystem::path&) -> Result<std::string> { return text; };
}

inline Reading<Subsystem> read_text(const std::string& text) { return read_subsystem("test.xml", text_source(text)); }

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

}  // namespace hirosco::descriptor::testing
