// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/wire_values.hpp"

#include <string>

#include "hirosco/parameter/text.hpp"

namespace hirosco::descriptor {

std::optional<std::vector<Value>> values_within(const Field& field, Octets big_endian) {
  if (big_endian.size() != field.octets()) return std::nullopt;
  if (field.type == Type::Text) {
    if (!is_fixed_text(big_endian)) return std::nullopt;
    return std::vector<Value>{std::string{fixed_words(big_endian)}};
  }
  const Number highest_bool{1};
  std::vector<Value> values;
  OctetReader reader{big_endian};
  for (std::uint32_t i = 0; i < field.count; ++i) {
    const Number number = read_number(reader, field.type);
    const bool too_low = field.minimum && number < *field.minimum;
    const bool too_high =
        (field.maximum && number > *field.maximum) || (field.type == Type::Bool && number > highest_bool);
    if (!number.is_finite() || too_low || too_high) return std::nullopt;
    values.emplace_back(number);
  }
  return values;
}

std::optional<std::vector<Value>> values_within(const Parameter& parameter, Octets big_endian) {
  if (parameter.members.empty()) return values_within(parameter.field, big_endian);
  if (big_endian.size() != parameter.octets()) return std::nullopt;
  std::vector<Value> all;
  for (const Parameter::Member& member : parameter.members) {
    const auto values = values_within(member.field, big_endian.first(member.field.octets()));
    if (!values) return std::nullopt;
    all.insert(all.end(), values->begin(), values->end());
    big_endian = big_endian.subspan(member.field.octets());
  }
  return all;
}

}  // namespace hirosco::descriptor
