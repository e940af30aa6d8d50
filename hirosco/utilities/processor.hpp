// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

/// What the processor is told so that memory that two of them share moves faster. It changes times only: nothing is right or wrong
/// by it, so that it stands apart from what has to be right.
namespace hirosco {

/// What two processors hand to each other at a time.
inline constexpr std::size_t cache_line_octets = 64;

/// Asks for the lines from here on to be written soon, so that all come at the same time and not one after another; of much memory
/// for the first ones. Realtime: bounded.
inline void claim_lines(std::byte* from, std::size_t octets) noexcept {
  constexpr std::size_t most = 1024;
  for (std::size_t at = 0; at < std::min(octets, most); at += cache_line_octets) {
#if defined(__x86_64__)
    asm volatile("prefetchw %0" : : "m"(from[at]));
#else
    __builtin_prefetch(from + at, 1);
#endif
  }
}

/// Between two attempts to read what another processor writes: from the fifth on the line is left to it for a moment, where the
/// processor knows how. Realtime: bounded.
inline void relax(int attempt) noexcept {
  constexpr int without_pause = 4;
  if (attempt < without_pause) return;
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace hirosco
