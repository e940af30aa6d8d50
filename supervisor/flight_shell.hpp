// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/memory.hpp"
#include "supervisor/platform/launch/flight_launcher.hpp"

/// The process around a supervisor, whatever its members are: sockets, signals, clock and log of the operating system around its steps.
namespace hirosco::supervisor {

/// What of a flight depends on how members come to life.
struct Deployment {
  std::unique_ptr<FlightLauncher> launcher;
  MemoryProvider* memory{nullptr};  ///< outlives the flight, as the next
  LinkMechanisms links;
};

/// What a deployment is made from.
struct FlightParts {
  const descriptor::Mission& mission;
  const Clock& clock;
  FlowFactory& flows;
  bool realtime{false};
  bool own_users{false};  ///< who started the flight has the right to end users of their own (docs/adr/0177)
};

/// Makes it, or prints why not and leaves the launcher empty.
using MakeDeployment = std::function<Deployment(const FlightParts& parts)>;

/// Flies a mission; returns the exit code. `arguments` are those of main(): --mission FILE [--log FILE] [--runtime FOLDER] [--mode NAME]
/// [--own-users] [--json|--quiet|--screen DESCRIPTOR].
int fly(int argc, char** argv, const MakeDeployment& deploy);

}  // namespace hirosco::supervisor
