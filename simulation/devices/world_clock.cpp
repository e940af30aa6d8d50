// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/world_clock.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hirosco::simulation {
namespace {

constexpr std::int64_t most_cycles_at_once = 40;  // of catching up after the process itself was held up

}  // namespace

/// While it runs it wakes after a cycle by its own clock, after two while it is driven by exchanges; what is longer was a pause. The
/// world may be ahead by less than a cycle: then the wake that was planned lay later by that. Up to half a cycle it was jitter, which the
/// world catches up with: its clock may not go slow by it. Woken later than that the machine starves.
WorldClock::Held WorldClock::wake(TimePoint now) noexcept {
  const TimePoint before = std::exchange(now_, now);
  if (!started_) return {};
  const Duration expected = planned_step();
  const Duration pause = now - std::max(before, world_time_) - expected;
  if (pause <= Duration{0}) return {};
  const bool starves = pause > cycle_ / 2;
  if (starves) world_time_ += pause;
  return {.pause = pause, .starved = starves ? expected : Duration{0}};
}

/// The world's clock is the craft's: it is moved by whole cycles and never away from `now` by more than one. An exchange
/// moves it by one cycle when the subsystem is as fast as the device, whatever their jitter; by all that is missing when
/// the subsystem is slower; by none when the own clock was there at the same instant. Without an exchange nothing until a
/// command is overdue by a cycle, then by the clock.
std::int64_t WorldClock::due(TimePoint now, bool exchanged) noexcept {
  // The first exchange moves the world by a cycle, as all that follow do.
  if (!std::exchange(started_, true)) world_time_ = exchanged ? now - cycle_ : now;
  const Duration behind = now - world_time_;
  if (!exchanged && behind < planned_step()) return 0;
  std::int64_t due = behind / cycle_;
  if (exchanged && behind > Duration{0}) due = std::max<std::int64_t>(due, 1);
  if (exchanged && behind <= Duration{0}) due = 0;
  by_own_clock_ = !exchanged;
  world_time_ += cycle_ * due;
  return std::min(due, most_cycles_at_once);
}

void WorldClock::count(std::int64_t cycles, bool exchanged) noexcept {
  cycles_ += static_cast<std::uint64_t>(cycles);
  if (!exchanged) own_cycles_ += static_cast<std::uint64_t>(cycles);
}

Duration WorldClock::world_cycle() const noexcept {
  return rate_ == 1 ? cycle_ : Duration{std::llround(1e3 * rate_ * seconds(cycle_) * 1e6)};
}

}  // namespace hirosco::simulation
