// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/python/python_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace hirosco::ground {
namespace {

constexpr std::array keywords{"False", "None",     "True",  "and",    "as",   "assert", "async",  "await",    "break",
                              "class", "continue", "def",   "del",    "elif", "else",   "except", "finally",  "for",
                              "from",  "global",   "if",    "import", "in",   "is",     "lambda", "nonlocal", "not",
                              "or",    "pass",     "raise", "return", "try",  "while",  "with",   "yield"};

[[nodiscard]] bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
[[nodiscard]] bool is_digit(char c) { return c >= '0' && c <= '9'; }
[[nodiscard]] char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
[[nodiscard]] char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

/// The code point at the front and its octets; U+FFFD and one octet for what is no UTF-8.
[[nodiscard]] std::pair<std::uint32_t, std::size_t> code_point(std::string_view text) {
  constexpr std::uint32_t replacement = 0xFFFD;
  const auto octet = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = octet(0);
  if (first < 0x80) return {first, 1};
  const std::size_t octets = first >= 0xF0 && first < 0xF5 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < octets) return {replacement, 1};
  std::uint32_t point = first & (0x7FU >> octets);
  for (std::size_t i = 1; i < octets; ++i) {
    if ((octet(i) & 0xC0) != 0x80) return {replacement, 1};
    point = point << 6 | (octet(i) & 0x3FU);
  }
  return {point, octets};
}

/// The inside of a literal.
[[nodiscard]] std::string escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const auto [point, octets] = code_point(text);
    text.remove_prefix(octets);
    if (point == '"' || point == '\\') result += fmt::format("\\{}", static_cast<char>(point));
    else if (point >= ' ' && point < 0x7F) result += static_cast<char>(point);
    else if (point < 0x80) result += fmt::format("\\x{:02x}", point);
    else if (point <= 0xFFFF) result += fmt::format("\\u{:04x}", point);
    else result += fmt::format("\\U{:08x}", point);
  }
  return result;
}

}  // namespace

std::string python_string(std::string_view text) { return "\"" + escaped(text) + "\""; }

std::string doc(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!blank) line += c;
    else if (!line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return escaped(line);
}

std::string docstring(const std::string& indent, const std::vector<std::string>& paragraphs) {
  std::string text = indent + "\"\"\"";
  for (std::size_t i = 0; i < paragraphs.size(); ++i)
    text += (i == 0 ? "" : paragraphs[i].empty() ? "\n" : "\n" + indent) + paragraphs[i];
  return text + (paragraphs.size() > 1 ? "\n" + indent : "") + "\"\"\"\n";
}

std::string PythonNames::variable(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const bool good = is_letter(c) || is_digit(c);
    if (!good && (result.empty() || result.back() == '_')) continue;
    result += good ? lower(c) : '_';
  }
  while (!result.empty() && result.back() == '_') result.pop_back();
  if (result.empty() || is_digit(result.front())) result.insert(0, "n");
  return unique(std::move(result));
}

std::string PythonNames::type(std::string_view name) {
  std::string result;
  bool first = true;
  for (const char c : name) {
    const bool good = is_letter(c) || is_digit(c);
    if (good) result += first ? upper(c) : lower(c);
    first = !good;
  }
  if (result.empty() || is_digit(result.front())) result.insert(0, "N");
  return unique(std::move(result));
}

std::string PythonNames::unique(std::string name) {
  const auto is_free = [this](const std::string& wanted) {
    return std::ranges::find(keywords, wanted) == keywords.end() && !taken_.contains(wanted);
  };
  std::string wanted = name;
  for (int number = 2; !is_free(wanted); ++number) wanted = fmt::format("{}_{}", name, number);
  taken_.insert(wanted);
  return wanted;
}

}  // namespace hirosco::ground
