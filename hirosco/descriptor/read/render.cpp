// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>

#include "hirosco/descriptor/read/detail/element_reader.hpp"
#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::descriptor {
namespace {

constexpr std::size_t max_shown = 160;
constexpr std::string_view bold = "\x1b[1m", red = "\x1b[1;31m", yellow = "\x1b[1;33m", green = "\x1b[1;32m",
                           plain = "\x1b[0m";

constexpr bool is_continuation(char c) noexcept { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

std::string_view line_of(std::string_view text, int line) noexcept {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (; line > 1; --line) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find('\n'));
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

/// The characters [begin, begin + count) of UTF-8 text.
std::string_view characters(std::string_view text, std::size_t begin, std::size_t count) noexcept {
  const auto octet_of = [&](std::size_t character) {
    std::size_t i = 0;
    while (i < text.size() && (is_continuation(text[i]) || character-- > 0)) ++i;
    return i;
  };
  const std::size_t first = octet_of(begin);
  return text.substr(first, octet_of(begin + count) - first);
}

}  // namespace

std::string render(const Diagnostic& problem, const FileSource& source, bool colour) {
  const auto paint = [colour](std::string_view ink, const std::string& text) {
    return colour ? fmt::format("{}{}{}", ink, text, plain) : text;
  };
  const std::string file = detail::printable(problem.file.string());
  const std::string message = detail::printable(problem.message), hint = detail::printable(problem.hint);
  const bool located = problem.at.line > 0;
  const std::string where = located ? fmt::format("{}:{}:{}:", file, problem.at.line, problem.at.column) : file + ":";
  const std::string grade = problem.grade == Grade::Error ? paint(red, "error:") : paint(yellow, "warning:");
  std::string text = fmt::format("{} {} {}: {}\n", paint(bold, where), grade, problem.code, message);
  const auto content = located && source ? source(problem.file) : fail(ErrorCode::NotFound, "");
  const std::string_view line = content ? line_of(*content, problem.at.line) : std::string_view{};
  if (line.empty()) return hint.empty() ? text : text + fmt::format("        {}\n", hint);

  // A long line is shown around the place, and its control characters never reach the terminal.
  const auto column = static_cast<std::size_t>(std::max(1, problem.at.column)) - 1;
  const std::size_t begin = column > max_shown / 2 ? column - max_shown / 2 : 0;
  const std::string shown = detail::printable(characters(line, begin, max_shown));
  const std::size_t length = std::min(std::max<std::size_t>(1, problem.length), max_shown - (column - begin));
  text += fmt::format("{:>5} | {}\n", problem.at.line, shown);
  text += fmt::format("      | {}{}", std::string(column - begin, ' '),
                      paint(green, fmt::format("^{:~<{}}", "", length - 1)));
  return text + (hint.empty() ? "\n" : fmt::format(" {}\n", hint));
}

}  // namespace hirosco::descriptor
