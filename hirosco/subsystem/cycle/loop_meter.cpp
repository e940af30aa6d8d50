// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/loop_meter.hpp"

#include <algorithm>
#include <chrono>

namespace hirosco {
namespace {

constexpr auto relaxed = std::memory_order_relaxed;

[[nodiscard]] float microseconds_of(Duration span) noexcept {
  return std::chrono::duration<float, std::micro>{span}.count();
}

}  // namespace

LoopMeter::LoopMeter(std::span<const descriptor::ServiceLoop> loops) noexcept
    : loops_{std::min(loops.size(), places_.size())} {
  for (std::size_t i = 0; i < loops_; ++i) promise(i, loops[i].budget);
}

void LoopMeter::promise(std::size_t place, Duration budget) noexcept {
  places_[place].budget_ns.store(budget.count(), relaxed);
}

void LoopMeter::account(std::size_t place, Duration used, std::uint64_t missed) noexcept {
  Place& loop = places_[place];
  if (used.count() > loop.longest_ns.load(relaxed)) loop.longest_ns.store(used.count(), relaxed);
  const Duration budget{loop.budget_ns.load(relaxed)};
  if (budget != Duration{} && used > budget) loop.exceeded.fetch_add(1, relaxed);
  if (missed != 0) loop.missed.fetch_add(missed, relaxed);
}

LoopStatistics LoopMeter::statistics() const noexcept {
  LoopStatistics told;
  for (std::size_t i = 0; i < loops_; ++i) {
    const Place& loop = places_[i];
    told.budget_us[i] = microseconds_of(Duration{loop.budget_ns.load(relaxed)});
    told.longest_us[i] = microseconds_of(Duration{loop.longest_ns.load(relaxed)});
    told.exceeded[i] = loop.exceeded.load(relaxed);
    told.missed[i] = loop.missed.load(relaxed);
  }
  return told;
}

}  // namespace hirosco
