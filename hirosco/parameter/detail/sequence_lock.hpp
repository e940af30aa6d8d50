// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>

/// Single-writer sequence lock on words. Invariants:
/// 1. One thread writes at a time. The sequence is odd exactly while it does, and only grows.
/// 2. Each word is stored with release after the odd sequence: a reader that sees a word of a store (acquire) sees that
///    store's odd sequence or a later one when it reads the sequence again.
/// 3. The even sequence is stored with release after all words: a reader that sees it (acquire) sees all of them.
/// So equal even sequences before and after mean: exactly the words of that store. No fence is used.
namespace hirosco::parameter_detail {

using Word = std::uint64_t;
inline constexpr std::size_t word_octets = sizeof(Word);

[[nodiscard]] constexpr std::size_t words_for(std::size_t octets) noexcept {
  return (octets + word_octets - 1) / word_octets;
}

/// Realtime: wait-free. Thread: the writer's.
inline void publish(std::atomic<Word>& sequence, std::atomic<Word>* words, const std::byte* from,
                    std::size_t octets) noexcept {
  const Word begin = sequence.load(std::memory_order_relaxed);
  sequence.store(begin + 1, std::memory_order_relaxed);
  const std::size_t whole = octets / word_octets;
  for (std::size_t i = 0; i < whole; ++i) {
    Word word;
    std::memcpy(&word, from + i * word_octets, word_octets);
    words[i].store(word, std::memory_order_release);
  }
  if (const std::size_t rest = octets % word_octets; rest != 0) {
    Word word{};
    std::memcpy(&word, from + whole * word_octets, rest);
    words[whole].store(word, std::memory_order_release);
  }
  sequence.store(begin + 2, std::memory_order_release);
}

/// Calls `read`, which loads words with acquire, until it met no store, at most `attempts` times.
/// Realtime: bounded. Thread: any.
template <class Read>
[[nodiscard]] bool read_whole(const std::atomic<Word>& sequence, int attempts, Read&& read) noexcept {
  for (int attempt = 0; attempt < attempts; ++attempt) {
    const Word before = sequence.load(std::memory_order_acquire);
    if (before % 2 != 0) continue;
    read();
    if (sequence.load(std::memory_order_relaxed) == before) return true;
  }
  return false;
}

}  // namespace hirosco::parameter_detail
