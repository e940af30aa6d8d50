// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "hirosco/descriptor/read/read.hpp"
#include "tests/fuzz/fuzz.hpp"

/// What holds of every reading of a descriptor, whatever the text was.
namespace hirosco::fuzz {

/// `text` is that of the file `fuzzed`.
inline void check_problem(const descriptor::Diagnostic& problem, const std::filesystem::path& fuzzed,
                          std::string_view text, const descriptor::FileSource& source) {
  const auto lines = std::ranges::count(text, '\n') + 1;
  expect(problem.code.size() == 5 && !problem.message.empty(), "a problem says what");
  expect(problem.at.line >= 0 && (problem.at.line == 0 || problem.at.column > 0), "a problem has a place, or a file");
  if (problem.file == fuzzed) expect(problem.at.line <= lines + 1, "a problem's place is in its file");
  const auto steers = [](char letter) {
    const auto octet = static_cast<unsigned char>(letter);
    return (octet < 0x20 && letter != '\n') || octet == 0x7F;
  };
  expect(std::ranges::none_of(descriptor::render(problem, source, false), steers),
         "nothing of what was read steers a terminal");
}

template <class T>
void check_reading(const descriptor::Reading<T>& reading, const std::filesystem::path& fuzzed, std::string_view text,
                   const descriptor::FileSource& source) {
  expect(reading.value.has_value() == reading.problems.empty(), "what is refused has a problem, and only that");
  for (const auto* list : {&reading.problems, &reading.warnings})
    for (const auto& problem : *list) check_problem(problem, fuzzed, text, source);
  if (reading.value) taken();
}

}  // namespace hirosco::fuzz
