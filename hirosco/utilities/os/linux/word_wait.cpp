// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/word_wait.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <ctime>
#include <limits>

namespace hirosco {
namespace {

// The standard has no atomic_ref to const yet; a lock-free load does not write, so a read-only mapping is safe.
[[nodiscard]] std::uint32_t load(const std::uint32_t& word) noexcept {
  return std::atomic_ref<std::uint32_t>{const_cast<std::uint32_t&>(word)}.load(std::memory_order_acquire);
}

}  // namespace

WordWait wait_on_word(const std::uint32_t& word, std::uint32_t seen, TimePoint deadline) noexcept {
  if (load(word) != seen) return WordWait::Changed;
  const Duration since = std::max(deadline.time_since_epoch(), Duration{0});
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since);
  const timespec limit{static_cast<std::time_t>(whole.count()), static_cast<long>((since - whole).count())};
  // FUTEX_WAIT_BITSET takes its limit as a point of CLOCK_MONOTONIC. Not private: the other end may be another process.
  const long result = ::syscall(SYS_futex, &word, FUTEX_WAIT_BITSET, seen, &limit, nullptr, FUTEX_BITSET_MATCH_ANY);
  const bool timed_out = result != 0 && errno == ETIMEDOUT;
  if (load(word) != seen) return WordWait::Changed;
  return timed_out ? WordWait::TimedOut : WordWait::Woken;
}

void wake_on_word(std::uint32_t& word) noexcept {
  static_cast<void>(::syscall(SYS_futex, &word, FUTEX_WAKE, std::numeric_limits<int>::max(), nullptr, nullptr, 0));
}

}  // namespace hirosco
