// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// Sleeping until somebody changes a word of memory that this process may share with others, and may be able to read only.
/// Where the system has no such wait (the portable backend) the sleeper looks every `word_look_period` instead, and waking does
/// nothing.
inline constexpr Duration word_look_period = std::chrono::microseconds{200};

/// How a wait ended.
enum class WordWait : std::uint8_t {
  Changed,  ///< the word is another one than `seen`
  Woken,  ///< it is not: somebody woke without a change, or a signal came
  TimedOut,
};

/// Until the word is other than `seen`, somebody wakes, or `deadline` of the monotonic clock has passed.
/// Realtime: blocks. Thread: any.
[[nodiscard]] WordWait wait_on_word(const std::uint32_t& word, std::uint32_t seen, TimePoint deadline) noexcept;
/// Wakes all who wait on this word, in whatever process. What was stored before is seen by them.
/// Realtime: one system call that does not wait. Thread: any.
void wake_on_word(std::uint32_t& word) noexcept;

}  // namespace hirosco
