// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "ground/clients/xtce/packet_root.hpp"

namespace hirosco::ground {

/// An argument of an event, as whoever writes its text needs it.
struct EventArgument {
  std::string name, path, unit;
};
/// By the id of the event.
using EventArguments = std::map<std::uint16_t, std::vector<EventArgument>>;

/// The parameters of a subsystem, its housekeeping structures, its events and the reports of its own services.
[[nodiscard]] EventArguments add_subsystem_reports(SpaceSystem& system, TypeSet& types, const PacketRoot& root,
                                                   const Catalogue& catalogue,
                                                   const descriptor::SubsystemDescriptor& subsystem);

}  // namespace hirosco::ground
