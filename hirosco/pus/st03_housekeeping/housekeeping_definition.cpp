// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st03_housekeeping/housekeeping_definition.hpp"

#include <optional>

namespace hirosco::pus {

std::expected<HousekeepingDefinition, FailureNotice> read_definition(Octets data, DefinitionOf what) {
  OctetReader reader{data};
  std::optional<std::size_t> empty_list;
  const auto read_ids = [&reader, &empty_list](std::vector<std::uint32_t>& ids, bool may_be_empty) {
    const std::size_t at = reader.position();
    const auto count = reader.get<std::uint8_t>();
    if (count == 0 && !may_be_empty && !empty_list) empty_list = at;
    for (std::size_t i = 0; i < count && reader.good(); ++i) ids.push_back(reader.get<std::uint32_t>());
  };
  HousekeepingDefinition definition;
  definition.id = reader.get<std::uint16_t>();
  if (what == DefinitionOf::NewStructure) definition.interval = reader.get<std::uint32_t>();
  const std::size_t first_count_at = reader.position();
  read_ids(definition.once, true);
  const auto sets = reader.get<std::uint8_t>();
  for (std::size_t i = 0; i < sets && reader.good(); ++i) {
    definition.sets.emplace_back();
    definition.sets.back().repetitions = reader.get<std::uint16_t>();
    read_ids(definition.sets.back().parameters, false);
  }
  if (!reader.exhausted()) return std::unexpected{FailureNotice{FailureCode::DataLength}};
  if (definition.once.empty() && definition.sets.empty()) empty_list = first_count_at;
  if (empty_list)
    return std::unexpected{FailureNotice{FailureCode::IllegalField}.with(static_cast<std::uint16_t>(*empty_list))};
  return definition;
}

std::size_t definition_octets(const HousekeepingLayout& layout) noexcept {
  std::size_t sum = 2 + 1 + 4 + 1 + 4 * layout.once.size() + 1;
  for (const auto& set : layout.sets) sum += 2 + 1 + 4 * set.values.size();
  return sum;
}

std::vector<std::byte> write_definition(const HousekeepingLayout& layout, bool enabled, std::uint32_t interval) {
  std::vector<std::byte> buffer(definition_octets(layout));
  OctetWriter writer{buffer};
  const auto put_ids = [&writer](const std::vector<SampledValue>& values) {
    writer.put(static_cast<std::uint8_t>(values.size()));
    for (const auto& value : values) writer.put(value.wire);
  };
  writer.put(layout.id).put(static_cast<std::uint8_t>(enabled ? 1 : 0)).put(interval);
  put_ids(layout.once);
  writer.put(static_cast<std::uint8_t>(layout.sets.size()));
  for (const auto& set : layout.sets) {
    writer.put(set.repetitions);
    put_ids(set.values);
  }
  return buffer;
}

}  // namespace hirosco::pus
