// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/commands/request.hpp"

#include <algorithm>
#include <cmath>

#include "ground/model/json.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/utilities/lower_case.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

[[nodiscard]] std::string number_text(const Number& number) {
  return number.is_whole() ? hirosco::to_string(number) : to_string(json_number(number.real()));
}

/// A number of JSON, which has 64-bit integers; a client that would round them gives all digits as a text.
[[nodiscard]] std::optional<Number> number_of(const json& given, Type type) {
  if (given.is_number_unsigned()) return given.get<std::uint64_t>();
  if (given.is_number_integer()) return given.get<std::int64_t>();
  constexpr double exact = 9007199254740992.0;  // 2^53: what is written beyond as a fraction or power was rounded
  if (given.is_number() && is_integer(type) && std::abs(given.get<double>()) > exact) return std::nullopt;
  if (given.is_number()) return given.get<double>();
  if (given.is_boolean() && type == Type::Bool) return given.get<bool>();
  if (!given.is_string() || (type != Type::Uint64 && type != Type::Int64)) return std::nullopt;
  const auto number = parse_number(given.get<std::string>());
  return number && number->is_whole() ? number : std::nullopt;
}

/// One value of an argument: words, a number, or the name of an entry of its enumeration.
[[nodiscard]] Answered<hirosco::Value> value_of(const json& given,
                                                const std::vector<descriptor::EnumerationText>& texts,
                                                const descriptor::Field& field) {
  if (field.type == Type::Text) {
    if (!given.is_string()) return refuse(400, field.name + ": a text is wanted");
    return given.get<std::string>();
  }
  if (given.is_string())
    for (const auto& entry : texts)
      if (lower_case(entry.text) == lower_case(given.get<std::string>())) return Number{entry.value};
  if (const auto number = number_of(given, field.type)) return *number;
  return refuse(400, field.name + ": neither a number nor a name that it knows");
}

[[nodiscard]] Answered<void> check_range(const hirosco::Value& value, const pus::Argument& argument) {
  const descriptor::Field& field = argument.field;
  const std::string unit = field.unit.empty() ? "" : " " + field.unit;
  if (const auto* words = std::get_if<std::string>(&value)) {
    if (pus::permits(argument, *words)) return {};
    return refuse(400, field.name + ": at most " + std::to_string(field.text_octets) + " octets of text are wanted");
  }
  const Number& number = std::get<Number>(value);
  if (!number.is_finite()) return refuse(400, field.name + ": not a finite number");
  if (field.minimum && number < *field.minimum)
    return refuse(
        400, field.name + ": " + number_text(number) + " is below its minimum " + number_text(*field.minimum) + unit);
  if (field.maximum && number > *field.maximum)
    return refuse(
        400, field.name + ": " + number_text(number) + " is above its maximum " + number_text(*field.maximum) + unit);
  if (!pus::permits(argument, number))
    return refuse(400, field.name + ": " + number_text(number) + " is none of " + pus::range_text(argument));
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
  std::vector<std::optional<hirosco::Value>> values;
  for (const auto& argument : function->arguments) {
    const auto& field = argument.field;
    const auto found = given.find(field.name);
    if (found == given.end() || found->is_null()) {
      if (!argument.fallback) return refuse(400, field.name + ": a value is wanted");
      values.insert(values.end(), pus::value_count(argument), std::nullopt);
      sent[field.name] = json_value(*argument.fallback);
      continue;
    }
    json list = found->is_array() ? *found : json::array({*found});
    if (list.size() != pus::value_count(argument))
      return refuse(400, field.name + ": " + std::to_string(field.count) + " values are wanted");
    const auto texts = catalogue.texts_of(*subsystem, *function, argument);
    for (json& entry : list) {
      const auto value = value_of(entry, texts, field);
      if (!value) return std::unexpected{value.error()};
      if (const auto fits = check_range(*value, argument); !fits) return std::unexpected{fits.error()};
      if (entry.is_number()) entry = json_value(*value);
      values.push_back(*value);
    }
    sent[field.name] = found->is_array() ? list : list.front();
  }
  Request request;
  request.subsystem = subsystem;
  request.function = wanted;
  request.arguments = to_string(sent);
  request.service = function->service;
  request.subtype = function->subtype;
  auto data = pus::encode_request(*function, values);
  if (!data) return refuse(400, wanted + ": " + data.error().text);
  request.data = std::move(*data);
  request.essential = function->essential;
  request.confirm = function->confirm;
  if (pus::goes_alone(*function)) request.way = Way::Alone;
  return request;
}

}  // namespace hirosco::ground
