// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/spacecraft/simulated_keeper.hpp"
#include "simulation/spacecraft/simulated_processes.hpp"

namespace hirosco::simulation {

/// What permit pages, journal and second inhibits say at the moment at which a supervisor dies in the middle of its step: nothing of
/// what the object goes on to do until its step returns has happened.
class LastMoment {
 public:
  LastMoment(SimulatedProcesses& processes, SimulatedKeeper& keeper);
  /// They say that again.
  void put_back();

 private:
  struct Page {
    PermitPage* page;
    std::uint32_t epoch, stop, mode_epoch, newest_stop, powered;
    std::uint64_t go, heartbeat;
  };

  SimulatedKeeper& keeper_;
  std::vector<Page> pages_;
  std::vector<std::byte> journal_;
  std::array<std::uint64_t, supervisor::most_inhibits> enabled_;
};

}  // namespace hirosco::simulation
