// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/keeper/kept.hpp"

/// The small process at the top (decision 1): starts the simulated devices and the supervisor, hands signals down, ends
/// what is left, and starts another supervisor where one has died (docs/adr/0093). Parses nothing from outside.
namespace hirosco::supervisor {

/// Above the supervisor's loop, its guard and every cycle, so the highest of a flight: what the keeper does when a supervisor has died
/// takes well below a millisecond.
inline constexpr int keeper_priority = 91;

struct KeeperPlan {
  ProcessStart supervisor;
  std::vector<ProcessStart> devices;
  std::optional<Duration> run_for;  ///< end in order after this time
  int beside{-1};  ///< a child of this process that is none of the flight's; -1: there is none
  std::vector<FlowAddress> inhibits;  ///< second inhibits of the mission's devices, in the order of kept_endnodes()
};

/// A service manager that has NOTIFY_SOCKET in the environment is told when the start mode is reached, and when the end begins.
/// Returns the exit code of the supervisor; 4 when it was ended by a signal or stood still, and no other went on. SIGUSR1 stops
/// everything that moves. Blocks until everything has ended, the subsystems of a supervisor that died before them included.
[[nodiscard]] int keep(KeeperPlan plan);

}  // namespace hirosco::supervisor
