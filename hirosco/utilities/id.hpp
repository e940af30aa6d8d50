// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>

namespace hirosco {

/// A number that names one kind of thing: explicit, comparable, not mixable with another kind.
template <class Tag, class Rep = std::uint16_t>
struct Id {
  Rep value{};
  constexpr Id() = default;
  explicit constexpr Id(Rep number) : value{number} {}
  friend constexpr auto operator<=>(Id, Id) = default;
};

using SubsystemId = Id<struct SubsystemTag>;          ///< APID of the subsystem, 1 = supervisor
using ConfigurationId = Id<struct ConfigurationTag, std::uint8_t>;
using LinkId = Id<struct LinkTag, std::uint8_t>;
using EventId = Id<struct EventTag>;                  ///< PUS event definition id
using StructureId = Id<struct StructureTag>;          ///< PUS housekeeping structure id

}  // namespace hirosco
