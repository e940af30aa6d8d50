// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/life.hpp"

/// POSIX marks robust mutexes, but lets nobody wait on one without locking it: the end of a process is known by its handle alone.
namespace hirosco {

Life life_of(std::uint32_t) noexcept { return Life::Unknown; }

Result<> hold_life(std::atomic<std::uint32_t>&) noexcept {
  return fail(ErrorCode::Unavailable, "the system marks no words");
}

Result<> wait_for_change(std::span<const SeenWord> words, Duration) noexcept {
  if (words.empty() || words.size() > most_seen_words)
    return fail(ErrorCode::OutOfRange, "words to wait on", static_cast<std::int64_t>(words.size()));
  return fail(ErrorCode::Unavailable, "the system does not wait on words");
}

void wake_waiters(const std::atomic<std::uint32_t>&) noexcept {}

}  // namespace hirosco
