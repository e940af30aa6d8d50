// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "ground/model/catalogue.hpp"

/// A project with which the ground station Yamcs (5.13) starts beside a flight of a mission: its database, the links to the flight's two
/// ports, the words of events, and stacks of telecommands. It listens on the loopback alone.
namespace hirosco::ground {

struct YamcsProject {
  std::string name;  ///< of the folder: that of Yamcs' instance, and "-yamcs"
  std::map<std::string, std::string> files;  ///< text by path below the folder
};
/// The same catalogue gives the same octets.
[[nodiscard]] YamcsProject yamcs_project(const Catalogue& catalogue);

}  // namespace hirosco::ground
