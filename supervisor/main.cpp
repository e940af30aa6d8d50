// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "supervisor/flight_shell.hpp"
#include "supervisor/platform/launch/system_launcher.hpp"

/// The first deployment: each member is a process of its own (docs/adr/0001).
int main(int argc, char** argv) {
  hirosco::SealedMemory memory;
  return hirosco::supervisor::fly(argc, argv, [&](const hirosco::supervisor::FlightParts& parts) {
    return hirosco::supervisor::Deployment{
        .launcher = std::make_unique<hirosco::supervisor::SystemLauncher>(parts.own_users),
        .memory = &memory,
        .links = hirosco::standard_link_mechanisms()};
  });
}
