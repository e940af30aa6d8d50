// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/module.hpp"

#include "hirosco/utilities/os/installation.hpp"

namespace hirosco::simulation {

std::expected<const DeviceModule*, std::string> load_device(std::string_view program) {
  const auto module = load_module_of(program, ModuleKind::SimulatedDevice);
  if (!module) return std::unexpected{module.error()};
  return static_cast<const DeviceModule*>((*module)->content);
}

}  // namespace hirosco::simulation
