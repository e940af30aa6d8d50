// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/module.hpp"
#include "hirosco/subsystem/process/run.hpp"

/// The program of every subsystem that is a module: what the module makes, in a process of its own.
int main(int argc, char** argv) {
  const auto& subsystem = *static_cast<const hirosco::SubsystemModule*>(hirosco_module()->content);
  return hirosco::run_subsystem(argc, argv, subsystem.make);
}
