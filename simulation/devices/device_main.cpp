// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "simulation/devices/device_shell.hpp"
#include "simulation/devices/module.hpp"

/// The program of every simulated device that is a module: what the module makes, in a process of its own.
int main(int argc, char** argv) {
  const auto& device = *static_cast<const hirosco::simulation::DeviceModule*>(hirosco_module()->content);
  const std::string name = std::filesystem::path{argv[0]}.filename();
  return hirosco::simulation::run_device(argc, argv, name.c_str(), device.make);
}
