// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/commands/request.hpp"

#include <algorithm>

#include "ground/model/json.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/utilities/lower_case.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

[[nodiscard]] std::string number_text(double number) { return to_string(json_number(number)); }

/// One value of an argument: a number, or the name of an entry of its enumeration.
[[nodiscard]] Answered<double> value_of(const json& given, const std::vector<descriptor::EnumerationText>& texts,
                                        const std::string& argument) {
  // A whole number that a double does not hold would be sent as its neighbour.
  constexpr std::uint64_t largest_exact = std::uint64_t{1} << 53;
  const bool inexact = (given.is_number_unsigned() && given.get<std::uint64_t>() > largest_exact) ||
                       (!given.is_number_unsigned() && given.is_number_integer() &&
                        given.get<std::int64_t>() < -static_cast<std::int64_t>(largest_exact));
  if (inexact) return refuse(400, argument + ": whole numbers are sent exactly up to 2^53 only");
  if (given.is_number()) return given.get<double>();
  if (given.is_string())
    for (const auto& entry : texts)
      if (lower_case(entry.text) == lower_case(given.get<std::string>())) return static_cast<double>(entry.value);
  return refuse(400, argument + ": neither a number nor a name that it knows");
}

[[nodiscard]] Answered<void> check_range(double value, const descriptor::Field& field) {
  const std::string unit = field.unit.empty() ? "" : " " + field.unit;
  if (!std::isfinite(value)) return refuse(400, field.name + ": not a finite number");
  if (field.minimum && value < *field.minimum)
    return refuse(
        400, field.name + ": " + number_text(value) + " is below its minimum " + number_text(*field.minimum) + unit);
  if (field.maximum && value > *field.maximum)
    return refuse(
        400, field.name + ": " + number_text(value) + " is above its maximum " + number_text(*field.maximum) + unit);
  return {};
}

}  // namespace

Answered<Request> request_of(const Catalogue& catalogue, const json& body) {
  const std::string name = text_of(body, "subsystem");
  const auto* subsystem = catalogue.find(std::string_view{name});
  if (subsystem == nullptr) return refuse(400, "no subsystem '" + name + "'");
  const std::string wanted = text_of(body, "function");
  const auto functions = catalogue.functions_of(*subsystem);
  const auto function = std::ranges::find(functions, wanted, &descriptor::Function::name);
  if (function == functions.end()) return refuse(400, name + " has no function '" + wanted + "'");
  const json none = json::object();
  const auto named = body.find("arguments");
  const json& given = named != body.end() ? *named : none;
  if (!given.is_object()) return refuse(400, "arguments: an object {name: value} is wanted");
  for (const auto& [argument, unused] : given.items())
    if (std::ranges::none_of(function->arguments, [&](const auto& known) { return known.field.name == argument; }))
      return refuse(400, wanted + " has no argument '" + argument + "'");

  json sent = json::object();
  std::vector<std::optional<double>> values;
  for (const auto& argument : function->arguments) {
    const auto& field = argument.field;
    const auto found = given.find(field.name);
    if (found == given.end() || found->is_null()) {
      if (!argument.fallback) return refuse(400, field.name + ": a value is wanted");
      values.insert(values.end(), field.count, std::nullopt);
      sent[field.name] = json_number(*argument.fallback);
      continue;
    }
    const json list = found->is_array() ? *found : json::array({*found});
    if (list.size() != field.count)
      return refuse(400, field.name + ": " + std::to_string(field.count) + " values are wanted");
    const auto texts = catalogue.texts_of(*subsystem, *function, field);
    for (const json& entry : list) {
      const auto value = value_of(entry, texts, field.name);
      if (!value) return std::unexpected{value.error()};
      if (const auto fits = check_range(*value, field); !fits) return std::unexpected{fits.error()};
      values.push_back(*value);
    }
    sent[field.name] = *found;
  }
  Request request;
  request.subsystem = subsystem;
  request.function = wanted;
  request.arguments = to_string(sent);
  request.service = function->service;
  request.subtype = function->subtype;
  auto data = pus::encode_request(*function, std::span<const std::optional<double>>{values});
  if (!data) return refuse(400, wanted + ": " + data.error().text);
  request.data = std::move(*data);
  if (pus::goes_alone(*function)) request.way = Way::Alone;
  return request;
}

}  // namespace hirosco::ground
