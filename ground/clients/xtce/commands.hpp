// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "ground/clients/xtce/packet_root.hpp"

namespace hirosco::ground {

/// The telecommand that all others stand on. Returns its path.
[[nodiscard]] std::string add_telecommand(SpaceSystem& system, TypeSet& types);

/// Paths of a subsystem's commands by the name of the request.
using CommandPaths = std::map<std::string, std::string, std::less<>>;

/// Every request of a subsystem that somebody on ground may send, and a WRITE_NAME for each parameter that may be set. `telecommand`
/// and `failure` are the paths of what they stand on and of the code that says why one has failed.
[[nodiscard]] CommandPaths add_commands(SpaceSystem& system, TypeSet& types, const PacketRoot& root,
                                        const Catalogue& catalogue, const descriptor::SubsystemDescriptor& subsystem,
                                        const std::string& telecommand, const std::string& failure);

}  // namespace hirosco::ground
