// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st03_housekeeping/housekeeping_definition.hpp"

#include <optional>
#include <span>

namespace hirosco::pus {

std::expected<HousekeepingDefinition, FailureNotice> read_definition(Octets data, DefinitionOf what) noexcept {
  OctetReader reader{data};
  std::optional<std::size_t> empty_list;
  const auto pass_ids = [&reader, &empty_list](bool may_be_empty) {
    const std::size_t at = reader.position();
    const auto count = reader.get<std::uint8_t>();
    if (count == 0 && !may_be_empty && !empty_list) empty_list = at;
    static_cast<void>(reader.get(sizeof(std::uint32_t) * count));
    return count;
  };
  HousekeepingDefinition definition;
  definition.id = reader.get<std::uint16_t>();
  if (what == DefinitionOf::NewStructure) definition.interval = reader.get<std::uint32_t>();
  const std::size_t first_count_at = reader.position();
  definition.lists = reader.rest();
  const auto once = pass_ids(true);
  const auto sets = reader.get<std::uint8_t>();
  for (std::size_t i = 0; i < sets && reader.good(); ++i) {
    static_cast<void>(reader.get<std::uint16_t>());
    pass_ids(false);
  }
  if (!reader.exhausted()) return std::unexpected{FailureNotice{FailureCode::DataLength}};
  if (once == 0 && sets == 0) empty_list = first_count_at;
  if (empty_list)
    return std::unexpected{FailureNotice{FailureCode::IllegalField}.with(static_cast<std::uint16_t>(*empty_list))};
  return definition;
}

std::size_t definition_octets(const HousekeepingLayout& layout) noexcept {
  std::size_t sum = 2 + 1 + 4 + 1 + 4 * layout.once().size() + 1;
  for (const auto& set : layout.sets()) sum += 2 + 1 + std::size_t{4} * set.count;
  return sum;
}

Octets write_definition(MutableOctets room, const HousekeepingLayout& layout, bool enabled,
                        std::uint32_t interval) noexcept {
  OctetWriter writer{room};
  const auto put_ids = [&](std::span<const std::uint32_t> places) {
    writer.put(static_cast<std::uint8_t>(places.size()));
    for (const std::uint32_t place : places) writer.put(layout.value(place).wire);
  };
  writer.put(layout.id).put(static_cast<std::uint8_t>(enabled ? 1 : 0)).put(interval);
  put_ids(layout.once());
  writer.put(static_cast<std::uint8_t>(layout.sets().size()));
  for (const auto& set : layout.sets()) {
    writer.put(set.repetitions);
    put_ids(layout.values_of(set));
  }
  return writer.written();
}

}  // namespace hirosco::pus
