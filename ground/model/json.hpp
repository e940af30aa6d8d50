// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/parameter/exact_number.hpp"
#include "hirosco/utilities/time.hpp"

/// How numbers, times and hostile texts stand in the ground station's JSON (ground/api/README.md).
namespace hirosco::ground {

/// JSON has no NaN and no infinities: they are texts that JavaScript's Number() understands.
[[nodiscard]] inline nlohmann::json json_number(double number) {
  if (std::isnan(number)) return "NaN";
  if (std::isinf(number)) return number > 0 ? "Infinity" : "-Infinity";
  // Whole numbers without ".0": counters read better and are shorter.
  constexpr double exact = 9.0e15;
  if (number == std::floor(number) && std::abs(number) < exact) return static_cast<std::int64_t>(number);
  return number;
}

/// The same exactly: a whole number that JavaScript would round is a text of all its digits.
[[nodiscard]] inline nlohmann::json json_number(const Number& number) {
  constexpr std::int64_t exact = std::int64_t{1} << 53;
  if (!number.is_whole()) return json_number(number.real());
  if (number > Number{exact} || number < Number{-exact}) return hirosco::to_string(number);
  return number.as<std::int64_t>().value_or(0);
}

[[nodiscard]] inline nlohmann::json json_value(const hirosco::Value& value) {
  if (const auto* words = std::get_if<std::string>(&value)) return *words;
  return json_number(std::get<Number>(value));
}

/// Since 2017; on board nobody counts leap seconds.
inline constexpr std::int64_t tai_minus_utc_s = 37;

[[nodiscard]] inline double json_time(OnboardTime t) { return seconds(t.time_since_epoch()); }

/// Times that do not fit become the nearest that does.
[[nodiscard]] inline OnboardTime onboard_time(double t) {
  constexpr double longest_s = 9.0e9;
  if (std::isnan(t)) return {};
  const double clamped = t > longest_s ? longest_s : t < 0.0 ? 0.0 : t;
  return OnboardTime{Duration{static_cast<std::int64_t>(clamped * 1e9)}};
}

/// A text of an object; empty when there is none.
[[nodiscard]] inline std::string text_of(const nlohmann::json& object, const char* name) {
  if (!object.is_object()) return {};
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

/// What a client sent; discarded when it is no JSON, names a key twice in one object (two readers could mean different ones), or nests
/// deeper than any request: each level of a copy takes stack.
[[nodiscard]] inline nlohmann::json parsed_request(const std::string& text) {
  using Event = nlohmann::json::parse_event_t;
  constexpr int deepest = 16;
  bool good = true;
  std::vector<std::set<std::string>> keys;  // of the objects that are open
  const auto watch = [&](int depth, Event event, const nlohmann::json& parsed) {
    good = good && depth <= deepest;
    if (!good) return false;
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::object_end) keys.pop_back();
    if (event == Event::key) good = keys.back().insert(parsed.get<std::string>()).second;
    return good;
  };
  auto request = nlohmann::json::parse(text, watch, false);
  // Not in braces, which would make an array of it.
  return good ? std::move(request) : nlohmann::json(nlohmann::json::value_t::discarded);
}

/// Octets that are no UTF-8 are replaced instead of thrown about.
[[nodiscard]] inline std::string to_string(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace hirosco::ground
