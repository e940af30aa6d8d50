// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/plan.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace hirosco::campaign {
namespace {

[[nodiscard]] std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream{line.substr(0, line.find('#'))};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

[[nodiscard]] Result<Duration> seconds_of(const std::string& text) {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size() || !(value >= 0) || value > 1e6)
    return fail(ErrorCode::Malformed, "not a time in seconds");
  return std::chrono::microseconds{std::llround(value * 1e6)};
}

[[nodiscard]] Result<> read_line(const std::string& line, FlightPlan& plan) {
  auto words = words_of(line);
  if (words.empty()) return ok();
  if (words.size() == 2 && words[0] == "seed") {
    HIROSCO_TRY_LET(plan.seed, number_of(words[1]));
    return ok();
  }
  if (words.size() == 2 && words[0] == "mode") {
    plan.mode = words[1];
    return ok();
  }
  if (words.size() == 2 && words[0] == "finale") {
    HIROSCO_TRY_LET(plan.finale, seconds_of(words[1]));
    return ok();
  }
  if (words.size() >= 2 && words[0] == "ends") {
    plan.ends.assign(words.begin() + 1, words.end());
    return ok();
  }
  if (words.size() < 2) return fail(ErrorCode::Malformed, "an action has a time and a verb");
  HIROSCO_TRY_LET(const Duration at, seconds_of(words[0]));
  words.erase(words.begin());
  plan.actions.push_back({at, std::move(words), line});
  return ok();
}

}  // namespace

Result<std::uint64_t> number_of(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size()) return fail(ErrorCode::Malformed, "not a number");
  return value;
}

Result<FlightPlan> read_plan(std::istream& text) {
  FlightPlan plan;
  std::int64_t number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (!read_line(line, plan)) return fail(ErrorCode::Malformed, "line of the plan", number);
  }
  std::ranges::stable_sort(plan.actions, {}, &Action::at);
  return plan;
}

Result<std::vector<std::byte>> octets_of_hex(std::string_view text) {
  std::vector<std::byte> octets;
  if (text.size() % 2 != 0) return fail(ErrorCode::Malformed, "odd number of digits");
  for (std::size_t i = 0; i < text.size(); i += 2) {
    unsigned value = 0;
    const auto [end, problem] = std::from_chars(text.data() + i, text.data() + i + 2, value, 16);
    if (problem != std::errc{} || end != text.data() + i + 2) return fail(ErrorCode::Malformed, "not hexadecimal");
    octets.push_back(static_cast<std::byte>(value));
  }
  return octets;
}

std::string hex_of(Octets octets) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  text.reserve(octets.size() * 2);
  for (const std::byte octet : octets) {
    text += digits[std::to_integer<unsigned>(octet) >> 4];
    text += digits[std::to_integer<unsigned>(octet) & 15];
  }
  return text;
}

}  // namespace hirosco::campaign
