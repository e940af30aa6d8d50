// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// A word of shared memory that the operating system itself marks when the thread that holds it is gone, however it went. That comes before
/// the memory of a dying process is given back, so the news of a death takes as long for a large process as for a small one
/// (docs/adr/0102). Linux: the robust list of futexes.
namespace hirosco {

/// What a life word says.
enum class Life : std::uint8_t {
  Unknown,  ///< nobody holds it yet, or never will
  Held,  ///< its holder lives
  Ended,  ///< the system marked it; also whoever wrote that mark by himself, who is to be treated alike
};
[[nodiscard]] Life life_of(std::uint32_t word) noexcept;

/// From now on the calling thread holds this word, until it ends; one word a thread, once. It must outlive the thread. A thread that
/// holds one gives up the system's care for its robust mutexes.
/// Unavailable: the system has no such list. Thread: the one that is to be watched.
[[nodiscard]] Result<> hold_life(std::atomic<std::uint32_t>& word) noexcept;

/// A word to wait on, and what it said when it was looked at.
struct SeenWord {
  const std::atomic<std::uint32_t>* word{nullptr};
  std::uint32_t seen{0};
};
/// So many words can be waited on at once.
inline constexpr std::size_t most_seen_words = 128;
/// Until one of them says something else, or somebody woke it, or `limit` is over; at once where one does already. The memory may be
/// read-only here. OutOfRange: none, or more than most_seen_words. Unavailable: the system cannot wait on several.
/// Realtime: blocks.
[[nodiscard]] Result<> wait_for_change(std::span<const SeenWord> words, Duration limit) noexcept;
/// Ends the waits on it.  Realtime: one system call that does not block.
void wake_waiters(const std::atomic<std::uint32_t>& word) noexcept;

}  // namespace hirosco
