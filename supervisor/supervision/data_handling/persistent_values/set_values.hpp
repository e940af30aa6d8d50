// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/octets.hpp"
#include "supervisor/supervision/data_handling/persistent_values/awaited_changes.hpp"
#include "supervisor/supervision/data_handling/persistent_values/value_set.hpp"

/// What telecommands and reports of a subsystem say of its parameters.
namespace hirosco::supervisor {

/// TC[20,3].
[[nodiscard]] bool sets_values(const pus::TelecommandView& telecommand);

/// The parameter that an id is of, or is in.
[[nodiscard]] std::uint32_t owner_of(const descriptor::SubsystemDescriptor& subsystem, std::uint32_t id);

/// The persistent parameters, of which `values` has those that are, that a telecommand to this subsystem sets, or has an argument of.
[[nodiscard]] AwaitedChanges::Ids set_by(const pus::TelecommandView& telecommand,
                                         const descriptor::SubsystemDescriptor& subsystem, const ValueSet& values);

/// Id and value of each that a TC[20,3] or a TM[20,2] of this subsystem has.
template <class Take>
void each_value(const descriptor::SubsystemDescriptor& subsystem, Octets data, Take take) {
  OctetReader reader{data};
  for (auto count = reader.get<std::uint8_t>(); count > 0; --count) {
    const auto id = reader.get<std::uint32_t>();
    const auto place = descriptor::find_parameter(subsystem, id);
    if (!reader.good() || !place) return;
    const descriptor::Parameter& parameter = subsystem.parameters[place->parameter];
    const Octets value = reader.get(parameter.octets(place->member));
    if (!reader.good()) return;
    take(id, value);
  }
}

}  // namespace hirosco::supervisor
