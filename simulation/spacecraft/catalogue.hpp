// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulation/spacecraft/spacecraft.hpp"

namespace hirosco::simulation {

/// The subsystems and devices of the repository, by the names that missions give their executables.
[[nodiscard]] const SubsystemCatalogue& known_subsystems();
[[nodiscard]] const DeviceCatalogue& known_devices();

}  // namespace hirosco::simulation
