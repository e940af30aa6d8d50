// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/python/python_values.hpp"

#include <fmt/format.h>

#include "ground/clients/python/python_text.hpp"

namespace hirosco::ground {
namespace {

/// More names would hide what matters in an editor's help.
constexpr std::size_t most_literals = 16;

[[nodiscard]] std::string python_value(const hirosco::Value& value) {
  const auto* words = std::get_if<std::string>(&value);
  return words != nullptr ? python_string(*words) : to_string(std::get<Number>(value));
}

}  // namespace

std::string pairs(const std::vector<descriptor::EnumerationText>& texts) {
  return "(" +
         joined(texts, " ",
                [](const auto& entry) { return fmt::format("({}, {}),", entry.value, python_string(entry.text)); }) +
         ")";
}

std::string field_call(const PythonValue& value) {
  const auto& field = value.field;
  std::string text = fmt::format("_r.Field({}, \"{}\"", python_string(field.name), to_text(field.type));
  const auto add = [&](const char* name, const std::optional<Number>& number) {
    if (number && number->is_finite()) text += fmt::format(", {}={}", name, to_string(*number));
  };
  if (field.count != 1) text += fmt::format(", count={}", field.count);
  if (!field.unit.empty()) text += ", unit=" + python_string(field.unit);
  add("minimum", field.minimum);
  add("maximum", field.maximum);
  if (value.fallback) text += ", default=" + python_value(*value.fallback);
  if (field.type == Type::Text)
    text += fmt::format(", most={}{}", field.text_octets, value.fixed ? ", fixed=True" : "");
  if (!value.texts.empty()) text += ", texts=" + pairs(value.texts);
  if (field.text) text += ", words=True";
  if (value.offset != 0) text += fmt::format(", offset={}", value.offset);
  return text + ")";
}

std::string fields_tuple(const std::vector<PythonValue>& values) {
  return "(" + joined(values, " ", [](const PythonValue& value) { return field_call(value) + ","; }) + ")";
}

std::string annotation(const PythonValue& value) {
  const bool real = value.field.type == Type::Float || value.field.type == Type::Double;
  const Type type = value.field.type;
  if (type == Type::Text) return "str";
  std::string one = real ? "float" : type == Type::Bool ? "bool" : "int";
  if (!value.texts.empty() && value.texts.size() <= most_literals)
    one = "_t.Union[" + one + ", _t.Literal[" +
          joined(value.texts, ", ", [](const auto& entry) { return python_string(entry.text); }) + "]]";
  else if (!value.texts.empty()) one = "_t.Union[" + one + ", str]";
  return value.field.count == 1 ? one : "_t.Sequence[" + one + "]";
}

std::string described(const PythonValue& value) {
  const auto& field = value.field;
  std::string text = (field.count == 1 ? "" : fmt::format("{} x ", field.count)) + std::string{to_text(field.type)};
  if (!field.unit.empty()) text += ", " + doc(field.unit);
  if (field.type == Type::Text) text += fmt::format(", at most {} octets of UTF-8", field.text_octets);
  if (field.minimum && field.maximum)
    text += fmt::format(", {} to {}", to_string(*field.minimum), to_string(*field.maximum));
  else if (field.minimum) text += fmt::format(", from {}", to_string(*field.minimum));
  else if (field.maximum) text += fmt::format(", up to {}", to_string(*field.maximum));
  if (value.fallback) text += fmt::format(", {} if left out", doc(python_value(*value.fallback)));
  if (!value.texts.empty())
    text += ": " + joined(value.texts, ", ",
                          [](const auto& entry) { return fmt::format("{} {}", entry.value, doc(entry.text)); });
  return text;
}

}  // namespace hirosco::ground
