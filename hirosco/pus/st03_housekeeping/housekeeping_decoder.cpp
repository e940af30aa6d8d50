// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "hirosco/parameter/number.hpp"
#include "hirosco/parameter/text.hpp"
#include "hirosco/utilities/utf8.hpp"

namespace hirosco::pus {
namespace {

template <class Entries>
[[nodiscard]] std::size_t octets_of_entries(const Entries& entries) {
  std::size_t sum = 0;
  for (const auto& entry : entries) sum += octets_of(entry.prototype.type) * entry.elements;
  return sum;
}

template <class Entries>
void read_entries(OctetReader& reader, const Entries& entries, std::vector<HousekeepingValue>& into) {
  for (const auto& entry : entries) {
    HousekeepingValue value = entry.prototype;
    if (value.type == Type::Text) value.words = printable_words(fixed_words(reader.get(entry.elements)));
    else
      for (std::uint32_t i = 0; i < entry.elements; ++i) value.values.push_back(get_number(reader, value.type));
    into.push_back(std::move(value));
  }
}

/// The shortest that reads back the same.
[[nodiscard]] std::string exact_text(double number) { return to_string(Number{number}); }

}  // namespace

std::vector<std::string> HousekeepingValue::texts() const {
  if (type == Type::Text) return {"'" + words + "'"};
  std::vector<std::string> all;
  for (const double number : values) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.6g", number);
    all.emplace_back(type == Type::Bool ? switch_word(number != 0.0) : std::string_view{text.data()});
  }
  return all;
}

std::string HousekeepingValue::json() const {
  if (type == Type::Text) {
    std::string quoted = "[\"";
    for (const char letter : words) {
      if (letter == '"' || letter == '\\') quoted += '\\';
      quoted += letter;
    }
    return quoted + "\"]";
  }
  std::string list;
  for (const double number : values) {
    list += list.empty() ? "[" : ",";
    if (type == Type::Bool) list += number != 0.0 ? "true" : "false";
    else list += std::isfinite(number) ? exact_text(number) : "null";
  }
  return list.empty() ? "[]" : list + "]";
}

HousekeepingDecoder::HousekeepingDecoder(const descriptor::SubsystemDescriptor& subsystem) {
  const auto add = [&](const std::vector<descriptor::HousekeepingStructure>& structures) {
    for (const auto& structure : structures) {
      Layout layout;
      layout.once = entries_of(subsystem, structure.sampled_once);
      layout.octets = sizeof structure.id + octets_of_entries(layout.once);
      for (const auto& set : structure.sampled_repeatedly) {
        layout.sets.push_back({set.repetitions, entries_of(subsystem, set.parameters)});
        layout.octets += set.repetitions * octets_of_entries(layout.sets.back().entries);
      }
      layouts_.emplace(structure.id, std::move(layout));
    }
  };
  add(subsystem.housekeeping);
  for (const auto& configuration : subsystem.configurations) add(configuration.housekeeping);
}

std::vector<HousekeepingDecoder::Entry> HousekeepingDecoder::entries_of(
    const descriptor::SubsystemDescriptor& subsystem, const std::vector<descriptor::ParameterRef>& references) {
  std::vector<Entry> entries;
  for (const auto& reference : references) {
    const auto& parameter = subsystem.parameters[reference.parameter];
    const bool structure = parameter.field.type == Type::Struct;
    for (const auto& field : descriptor::fields_of(subsystem, reference)) {
      const std::string name = structure ? parameter.field.name + "." + field.name : field.name;
      entries.push_back({{.name = name, .unit = field.unit, .type = field.type}, field.elements()});
    }
  }
  return entries;
}

Result<std::vector<HousekeepingValue>> HousekeepingDecoder::decode(Octets source_data) const {
  OctetReader reader{source_data};
  const auto id = reader.get<std::uint16_t>();
  if (!reader.good()) return fail(ErrorCode::Malformed, "housekeeping report without a structure id");
  const auto [first, last] = layouts_.equal_range(id);
  if (first == last) return fail(ErrorCode::NotFound, "no such housekeeping structure", id);
  for (auto candidate = first; candidate != last; ++candidate) {
    const Layout& layout = candidate->second;
    if (layout.octets != source_data.size()) continue;
    std::vector<HousekeepingValue> values;
    read_entries(reader, layout.once, values);
    for (const auto& set : layout.sets) {
      std::vector<HousekeepingValue> group;
      for (std::uint16_t i = 0; i < set.repetitions; ++i) {
        group.clear();
        read_entries(reader, set.entries, group);
      }
      values.insert(values.end(), group.begin(), group.end());
    }
    return values;
  }
  return fail(ErrorCode::Malformed, "housekeeping report is not of its structure's length", id);
}

}  // namespace hirosco::pus
