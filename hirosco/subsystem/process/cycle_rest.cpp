// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/cycle_rest.hpp"

#include <algorithm>

#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/word_wait.hpp"

namespace hirosco {

std::optional<Duration> rest_until(TimePoint planned, const CycleWait& wait, const Clock& clock) noexcept {
  if (wait.spin > Duration{}) {
    sleep_until(planned - wait.spin);
    const Duration used = clock.processor();
    static_cast<void>(spin_until(planned, wait.spin, clock));
    return used;
  }
  if (wait.word == nullptr) {
    sleep_until(planned);
    return std::nullopt;
  }
  // A sample that came meanwhile is no reason to ask the system for anything but the rest of the least distance.
  if (clock.now() < wait.earliest) sleep_until(std::min(wait.earliest, planned));
  while (wait_on_word(*wait.word, wait.seen, planned) == WordWait::Woken)
    sleep_until(std::min(clock.now() + wait.least, planned));
  return std::nullopt;
}

std::uint64_t spin_until(TimePoint due, Duration most, const Clock& clock) noexcept {
  const auto limit = static_cast<std::uint64_t>(std::max<std::int64_t>(most.count(), 1));
  std::uint64_t looks = 1;
  while (clock.now() < due && looks < limit) ++looks;
  return looks;
}

}  // namespace hirosco
