// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "simulation/spacecraft/spacecraft.hpp"

namespace hirosco::simulation {

/// The makers of all that a mission names, by its programs, from the modules of these.
struct Modules {
  SubsystemCatalogue subsystems;
  DeviceCatalogue devices;
  std::map<std::string, std::string> missing;  ///< programs without a module that can be taken, and why in words
};

[[nodiscard]] Modules load_modules(const descriptor::Mission& mission);

/// What Software-Init will find of an author's mistakes against this descriptor, without a flight.
[[nodiscard]] std::vector<Mistake> try_introduction(Subsystem& author,
                                                    const descriptor::SubsystemDescriptor& described);

}  // namespace hirosco::simulation
