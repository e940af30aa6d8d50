// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

namespace hirosco::pus {

/// What a report structure consists of, as TC[3,1] and TC[3,29] carry it: parameters by their ids on the wire, not looked up yet. They
/// lie in the telecommand.
struct HousekeepingDefinition {
  std::uint16_t id{};
  std::uint32_t interval{};  ///< cycles; of TC[3,1]
  Octets lists;  ///< as read_definition() found them: of what is sampled once, how many sets, each set

  /// Calls `list(repetitions, ids)` of each: ids u32 each, no repetitions of what is sampled once.
  template <class List>
  void each_list(List&& list) const {
    OctetReader reader{lists};
    const auto ids = [&reader] { return reader.get(sizeof(std::uint32_t) * reader.get<std::uint8_t>()); };
    list(std::optional<std::uint16_t>{}, ids());
    const auto sets = reader.get<std::uint8_t>();
    for (std::size_t i = 0; i < sets && reader.good(); ++i) {
      const auto repetitions = reader.get<std::uint16_t>();
      list(std::optional{repetitions}, ids());
    }
  }
};

enum class DefinitionOf : std::uint8_t {
  NewStructure,  ///< TC[3,1]
  AppendedParameters  ///< TC[3,29]: without an interval
};

/// Of application data, which outlives it. What is refused of them: their length, or a list without a parameter, with where that is.
[[nodiscard]] std::expected<HousekeepingDefinition, FailureNotice> read_definition(Octets data,
                                                                                   DefinitionOf what) noexcept;

/// Octets of the definition in TM[3,10].
[[nodiscard]] std::size_t definition_octets(const HousekeepingLayout& layout) noexcept;
/// Source data of TM[3,10], in `room` of at least definition_octets(): `layout` with the interval that is in force.
[[nodiscard]] Octets write_definition(MutableOctets room, const HousekeepingLayout& layout, bool enabled,
                                      std::uint32_t interval) noexcept;

}  // namespace hirosco::pus
