// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>

/// Copies between a sample's memory, which another process reads or writes meanwhile, and one's own, 16 octets at a time. The language knows no access of more than
/// 8 octets that two processes may have to the same place, so it is told to the processor. x86-64 is one that has loads from ordinary memory (written back, as all memory that
/// links are made of) in their order and stores in theirs, as acquire and release ask for; nobody asks that the 16 octets are of one instant, as the sequence around them says whether
/// all of them are. No sanitizer sees the accesses to the sample's memory: whoever calls has looked whether `octets` are there. Each returns how many octets
/// it has copied: none on another processor, nor where a thread sanitizer looks on, who would not see it. What is left its caller does word by word.
namespace hirosco::detail {

#if defined(__SANITIZE_THREAD__)
#define HIROSCO_WIDE_WORDS 0
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define HIROSCO_WIDE_WORDS 0
#endif
#endif
#if !defined(HIROSCO_WIDE_WORDS)
#if defined(__x86_64__)
#define HIROSCO_WIDE_WORDS 1
#else
#define HIROSCO_WIDE_WORDS 0
#endif
#endif

#if HIROSCO_WIDE_WORDS
using WideWord = long long __attribute__((vector_size(16)));
/// What the processor reads or writes of the sample's memory: octets, of which no alignment and no type is claimed.
using WideOctets = std::byte[sizeof(WideWord)];

/// Nothing that stands before it in the program is done behind it, and nothing behind it before it. The processor does so by itself.
inline void keep_order() noexcept { asm volatile("" : : : "memory"); }

/// `move` for each whole word of `octets`, four of them a step. Returns the octets behind the last one.
template <class Move>
inline std::size_t by_wide_words(std::size_t octets, const Move& move) noexcept {
  constexpr std::size_t word = sizeof(WideWord);
  std::size_t at = 0;
  for (; at + 4 * word <= octets; at += 4 * word) {
    move(at);
    move(at + word);
    move(at + 2 * word);
    move(at + 3 * word);
  }
  for (; at + word <= octets; at += word) move(at);
  return at;
}
#endif

/// Realtime: bounded.
inline std::size_t store_wide([[maybe_unused]] const std::byte* from, [[maybe_unused]] std::byte* to,
                              [[maybe_unused]] std::size_t octets) noexcept {
  std::size_t at = 0;
#if HIROSCO_WIDE_WORDS
  keep_order();
  at = by_wide_words(octets, [&](std::size_t each) {
    WideWord value;
    std::memcpy(&value, from + each, sizeof value);
    asm volatile("movdqu %1, %0" : "=m"(*reinterpret_cast<WideOctets*>(to + each)) : "x"(value));
  });
  keep_order();
#endif
  return at;
}

/// Into two places of one's own.  Realtime: bounded.
inline std::size_t load_wide([[maybe_unused]] const std::byte* from, [[maybe_unused]] std::byte* one,
                             [[maybe_unused]] std::byte* other, [[maybe_unused]] std::size_t octets) noexcept {
  std::size_t at = 0;
#if HIROSCO_WIDE_WORDS
  keep_order();
  at = by_wide_words(octets, [&](std::size_t each) {
    WideWord value;
    asm volatile("movdqu %1, %0" : "=x"(value) : "m"(*reinterpret_cast<const WideOctets*>(from + each)));
    std::memcpy(one + each, &value, sizeof value);
    std::memcpy(other + each, &value, sizeof value);
  });
  keep_order();
#endif
  return at;
}

#undef HIROSCO_WIDE_WORDS

}  // namespace hirosco::detail
