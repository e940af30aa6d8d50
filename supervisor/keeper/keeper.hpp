// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/time.hpp"

/// The small process at the top (decision 1): starts the simulated devices and the supervisor, hands signals down, ends
/// what is left. Parses nothing from outside.
namespace hirosco::supervisor {

/// The supervisor finds the reading end of a pipe here; it is closed when the keeper is gone.
inline constexpr int keeper_descriptor = 6;

struct KeeperPlan {
  ProcessStart supervisor;
  std::vector<ProcessStart> devices;
  std::optional<Duration> run_for;  ///< end in order after this time
};

/// Returns the exit code of the supervisor, 4 when it was ended by a signal. Blocks until everything has ended.
[[nodiscard]] int keep(KeeperPlan plan);

}  // namespace hirosco::supervisor
