// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <vector>

#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"

namespace hirosco::pus {

/// What a report structure consists of, as TC[3,1] and TC[3,29] carry it: parameters by their ids on the wire, not looked up yet.
struct HousekeepingDefinition {
  struct Set {
    std::uint16_t repetitions{};
    std::vector<std::uint32_t> parameters;
  };
  std::uint16_t id{};
  std::uint32_t interval{};  ///< cycles; of TC[3,1]
  std::vector<std::uint32_t> once;
  std::vector<Set> sets;
};

enum class DefinitionOf : std::uint8_t {
  NewStructure,  ///< TC[3,1]
  AppendedParameters  ///< TC[3,29]: without an interval
};

/// Of application data. What is refused of them: their length, or a list without a parameter, with where that is.
[[nodiscard]] std::expected<HousekeepingDefinition, FailureNotice> read_definition(Octets data, DefinitionOf what);

/// Octets of the definition in TM[3,10].
[[nodiscard]] std::size_t definition_octets(const HousekeepingLayout& layout) noexcept;
/// Source data of TM[3,10]: `layout` with the interval that is in force.
[[nodiscard]] std::vector<std::byte> write_definition(const HousekeepingLayout& layout, bool enabled,
                                                      std::uint32_t interval);

}  // namespace hirosco::pus
