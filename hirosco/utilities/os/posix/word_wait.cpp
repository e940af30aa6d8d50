// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/word_wait.hpp"

#include <algorithm>
#include <atomic>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/thread.hpp"

// POSIX.1-2008 has no wait on a word that one may only read: who waits looks, often enough for a cycle of a millisecond.
namespace hirosco {

WordWait wait_on_word(const std::uint32_t& word, std::uint32_t seen, TimePoint deadline) noexcept {
  const SystemClock clock{Duration{0}};
  for (;;) {
    const auto found = std::atomic_ref<std::uint32_t>{const_cast<std::uint32_t&>(word)}.load(std::memory_order_acquire);
    if (found != seen) return WordWait::Changed;
    const TimePoint now = clock.now();
    if (now >= deadline) return WordWait::TimedOut;
    sleep_until(std::min(deadline, now + word_look_period));
  }
}

void wake_on_word(std::uint32_t&) noexcept {}

}  // namespace hirosco
