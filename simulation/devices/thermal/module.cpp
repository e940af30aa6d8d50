// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/module.hpp"
#include "simulation/devices/thermal/thermal_unit.hpp"

const hirosco::Module* hirosco_module() noexcept {
  return &hirosco::simulation::device_module<hirosco::simulation::ThermalUnit>;
}
