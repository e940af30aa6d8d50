// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/simulated_loops.hpp"

#include <algorithm>

namespace hirosco::simulation {

TimePoint SimulatedLoops::next_wake() const noexcept {
  TimePoint next = SimulatedProcess::never;
  const bool no_cycles = cycles_wait();
  for (const auto& process : parts_.processes.all()) {
    next = std::min({next, process->service_due(), process->own_loops_due()});
    if (!no_cycles) next = std::min(next, process->cycle_due());
  }
  return next;
}

void SimulatedLoops::step(TimePoint now) {
  const auto& processes = parts_.processes.all();
  for (const auto& process : processes)
    if (process->cycle_due() <= now && !cycles_wait()) step_cycle(*process, now);
  for (const auto& process : processes)
    if (process->service_due() <= now) process->step_service(now);
  for (const auto& process : processes) process->step_own_loops(now);
}

/// One that spins in a cycle has the processor of all cycles as long as it has real-time priority, and makes none.
bool SimulatedLoops::cycles_wait() const noexcept {
  return std::ranges::any_of(parts_.processes.all(), [](const auto& process) { return process->keeps_processor(); });
}

void SimulatedLoops::step_cycle(SimulatedProcess& process, TimePoint now) {
  if (!(measured_by_ != nullptr ? measured_cycle(process) : process.step_cycle())) return;
  // The device answers the exchange at once: its status is there for the next cycle (decision 29).
  parts_.devices.step_of(process.name(), now);
  if (watch_) watch_(process.name(), now);
  // Whose cycle starts with a sample is woken when its producer's cycle is over, by the word that wakes a process; in the order of
  // processes, so that one seed stays one flight.
  for (const auto& waiting : parts_.processes.all()) waiting->wake_cycle(now);
}

bool SimulatedLoops::measured_cycle(SimulatedProcess& process) {
  const Duration used = measured_by_->processor();
  const TimePoint begun = measured_by_->now();
  const bool made = process.step_cycle();
  const Duration wall = measured_by_->now() - begun;
  const Duration processor = measured_by_->processor() - used;
  if (made) taken_(process.name(), {.wall = wall, .processor = processor});
  return made;
}

}  // namespace hirosco::simulation
