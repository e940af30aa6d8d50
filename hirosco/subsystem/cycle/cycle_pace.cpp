// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/cycle_pace.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace hirosco {
namespace {

// The standard has no atomic_ref to const yet; a lock-free load does not write, so a read-only mapping is safe.
[[nodiscard]] std::uint32_t load(const std::uint32_t& word) noexcept {
  return std::atomic_ref<std::uint32_t>{const_cast<std::uint32_t&>(word)}.load(std::memory_order_acquire);
}

}  // namespace

bool CycleWait::arrived() const noexcept { return word != nullptr && load(*word) != seen; }

void CyclePace::begin(const descriptor::Configuration& configuration, bool precise) noexcept {
  longest_ = configuration.sampling;
  least_ = configuration.least;
  by_samples_ = !configuration.started_by.empty();
  counted_ = false;
  wait_ = {.least = least_, .spin = precise ? configuration.spin : Duration{}};
}

CyclePace::Start CyclePace::start(TimePoint planned, TimePoint started) noexcept {
  if (!by_samples_) return {.planned = planned};
  Start start{.planned = std::min(planned, started), .arrived = started < planned, .counts = true};
  wait_.earliest = started + least_;
  const Duration since = start.planned - counted_at_;
  const bool first = !std::exchange(counted_, true);
  start.counts = first || since >= longest_;
  const bool anew = first || since >= 2 * longest_;
  if (start.counts) counted_at_ = anew ? start.planned : counted_at_ + longest_;
  return start;
}

void CyclePace::look(const std::uint32_t* word) noexcept {
  wait_.word = word;
  if (word != nullptr) wait_.seen = load(*word);
}

CyclePace::Next CyclePace::next(TimePoint planned, TimePoint finished) const noexcept {
  const TimePoint due = planned + longest_;
  if (finished <= due) return {due};
  if (by_samples_) return {finished};
  // Missed cycles are skipped, not made up for: the next one is due on the grid and in the future.
  const auto skipped = (finished - due) / longest_ + 1;
  return {due + skipped * longest_, static_cast<std::uint64_t>(skipped)};
}

}  // namespace hirosco
