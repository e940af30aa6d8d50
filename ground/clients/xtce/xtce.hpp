// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ground/clients/xtce/commands.hpp"
#include "ground/clients/xtce/packet_root.hpp"
#include "ground/clients/xtce/subsystem_reports.hpp"

/// A mission's telemetry and telecommands as XTCE 1.2 (CCSDS 660.0-B-2), from its descriptors.
namespace hirosco::ground {

struct Xtce {
  std::string name;  ///< of the mission as XTCE permits it
  std::string text;  ///< the document
  std::string event_id;  ///< path of the parameter that has the id of an event
  EventNames events;  ///< how its values are called
  /// Of the catalogue's subsystems, in their order.
  std::vector<EventArguments> arguments;
  std::vector<CommandPaths> commands;
};
/// The same catalogue gives the same octets.
[[nodiscard]] Xtce xtce(const Catalogue& catalogue);

}  // namespace hirosco::ground
