// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

#include "simulation/spacecraft/simulated_devices.hpp"
#include "simulation/spacecraft/simulated_processes.hpp"

namespace hirosco::simulation {

/// The loops of all processes, which share what a computer has: one processor for all cycles (adr 0007), and whoever spins there keeps it;
/// service loops have it to themselves.
class SimulatedLoops {
 public:
  struct Parts {
    SimulatedProcesses& processes;
    SimulatedDevices& devices;  ///< answer the exchange of a cycle
  };
  explicit SimulatedLoops(const Parts& parts) : parts_{parts} {}

  /// Called after every cycle.
  void on_cycle(std::function<void(std::string_view subsystem, TimePoint)> watch) { watch_ = std::move(watch); }
  /// When the first of them is due.
  [[nodiscard]] TimePoint next_wake() const noexcept;
  /// Those that are due: cycles, service loops, loops of services of their own, each in the order of processes.
  void step(TimePoint now);

 private:
  [[nodiscard]] bool cycles_wait() const noexcept;
  void step_cycle(SimulatedProcess& process, TimePoint now);

  Parts parts_;
  std::function<void(std::string_view, TimePoint)> watch_;
};

}  // namespace hirosco::simulation
