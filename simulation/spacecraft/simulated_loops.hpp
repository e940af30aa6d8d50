// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>
#include <utility>

#include "hirosco/utilities/time.hpp"
#include "simulation/spacecraft/simulated_devices.hpp"
#include "simulation/spacecraft/simulated_processes.hpp"

namespace hirosco::simulation {

/// What a cycle has taken of the computer that simulates it.
struct CycleTaken {
  Duration wall;
  Duration processor;  ///< of the thread, which nobody else had meanwhile
};

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
  /// Called after every cycle that was made, before its devices answer, with what that took by `clock`, which must outlive it. Nothing in the flight
  /// knows of it.
  void measure_cycles(const Clock& clock, std::function<void(std::string_view subsystem, CycleTaken)> told) {
    measured_by_ = &clock;
    taken_ = std::move(told);
  }
  /// When the first of them is due.
  [[nodiscard]] TimePoint next_wake() const noexcept;
  /// Those that are due: cycles, service loops, loops of services of their own, each in the order of processes.
  void step(TimePoint now);

 private:
  [[nodiscard]] bool cycles_wait() const noexcept;
  void step_cycle(SimulatedProcess& process, TimePoint now);
  [[nodiscard]] bool measured_cycle(SimulatedProcess& process);

  Parts parts_;
  std::function<void(std::string_view, TimePoint)> watch_;
  const Clock* measured_by_{nullptr};
  std::function<void(std::string_view, CycleTaken)> taken_;
};

}  // namespace hirosco::simulation
