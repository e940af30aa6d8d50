// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/target.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace hirosco::ground {
namespace {

[[nodiscard]] int hex_digit(char letter) {
  if (letter >= '0' && letter <= '9') return letter - '0';
  if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
  if (letter >= 'A' && letter <= 'F') return letter - 'A' + 10;
  return -1;
}

[[nodiscard]] std::optional<std::string> decoded(std::string_view text, bool plus_is_space) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%') {
      if (i + 2 >= text.size()) return std::nullopt;
      const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
      if (high < 0 || low < 0 || high * 16 + low == 0) return std::nullopt;
      result += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      result += plus_is_space && text[i] == '+' ? ' ' : text[i];
    }
  }
  return result;
}

}  // namespace

std::optional<Target> read_target(std::string_view target) {
  const auto question = target.find('?');
  auto path = decoded(target.substr(0, question), false);
  if (!path) return std::nullopt;
  Target result{std::move(*path), {}};
  std::string_view rest = question == std::string_view::npos ? std::string_view{} : target.substr(question + 1);
  while (!rest.empty()) {
    const auto end = std::min(rest.find('&'), rest.size());
    const std::string_view one = rest.substr(0, end);
    rest = end < rest.size() ? rest.substr(end + 1) : std::string_view{};
    const auto equals = std::min(one.find('='), one.size());
    const auto name = decoded(one.substr(0, equals), true);
    const auto value = decoded(one.substr(std::min(equals + 1, one.size())), true);
    if (!name || !value) return std::nullopt;
    result.parameters.emplace(*name, *value);
  }
  return result;
}

std::optional<std::string> Target::text(const std::string& name) const {
  const auto found = parameters.find(name);
  return found != parameters.end() ? std::optional{found->second} : std::nullopt;
}

std::optional<double> Target::number(const std::string& name) const {
  const auto found = text(name);
  if (!found) return std::nullopt;
  double value = 0.0;
  const auto [end, failed] = std::from_chars(found->data(), found->data() + found->size(), value);
  const bool whole = failed == std::errc{} && end == found->data() + found->size() && std::isfinite(value);
  return whole ? std::optional{value} : std::nullopt;
}

}  // namespace hirosco::ground
