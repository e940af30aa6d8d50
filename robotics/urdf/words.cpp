// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>

#include "robotics/urdf/findings.hpp"

namespace hirosco::robotics::urdf {
namespace {

[[nodiscard]] bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

std::optional<double> number(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(std::abs(value) <= largest_number))
    return std::nullopt;
  return value;
}

std::optional<Vector3> three(std::string_view text) {
  Vector3 values;
  for (int i = 0; i < 3; ++i) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    const std::size_t end = std::min(text.find_first_of(" \t\r\n"), text.size());
    const auto value = number(text.substr(0, end));
    if (!value) return std::nullopt;
    values[i] = *value;
    text.remove_prefix(end);
  }
  return std::ranges::all_of(text, is_space) ? std::optional{values} : std::nullopt;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t most = 64;
  std::string result{text.substr(0, most)};
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  while (text.size() > most && !result.empty() && (static_cast<unsigned char>(result.back()) & 0x80) != 0)
    result.pop_back();
  return "'" + result + (text.size() > most ? "...'" : "'");
}

}  // namespace hirosco::robotics::urdf
