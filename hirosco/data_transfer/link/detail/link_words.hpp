// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/utilities/os/word_wait.hpp"
#include "hirosco/utilities/processor.hpp"

namespace hirosco::detail {

/// What the words of a link's shared memory have in common, whatever its mechanism: 8 octets each in the order of the machine,
/// read and written as a whole.  Realtime: wait-free.
struct LinkWords {
  using Word = std::uint64_t;
  static_assert(std::atomic_ref<Word>::is_always_lock_free);

  static constexpr std::size_t line = cache_line_octets;
  static constexpr std::size_t page = 4096;
  static constexpr int attempts = 8;

  static constexpr std::size_t in_lines(std::size_t octets) noexcept { return (octets + line - 1) / line * line; }
  static constexpr std::size_t words_of(std::size_t octets) noexcept {
    return (octets + sizeof(Word) - 1) / sizeof(Word);
  }
  static bool on_a_line(const void* start) noexcept {
    return start != nullptr && std::bit_cast<std::uintptr_t>(start) % line == 0;
  }

  static std::atomic_ref<Word> word(std::byte* memory, std::size_t at) noexcept {
    return std::atomic_ref<Word>{*reinterpret_cast<Word*>(memory + at)};
  }
  // The standard has no atomic_ref to const yet; a lock-free load does not write, so a read-only mapping is safe.
  static Word load(const std::byte* memory, std::size_t at, std::memory_order order) noexcept {
    return word(const_cast<std::byte*>(memory), at).load(order);
  }

  /// The half of a word that changes with each step of a count: what a consumer can sleep on.
  static const std::uint32_t* low_half(const std::byte* memory, std::size_t at) noexcept {
    constexpr std::size_t low = std::endian::native == std::endian::little ? 0 : sizeof(std::uint32_t);
    return reinterpret_cast<const std::uint32_t*>(memory + at + low);
  }
  static void wake(std::byte* memory, std::size_t at) noexcept {
    wake_on_word(const_cast<std::uint32_t&>(*low_half(memory, at)));
  }

  static Word stamp_of(TimePoint sampled_at) noexcept {
    return std::bit_cast<Word>(std::int64_t{sampled_at.time_since_epoch().count()});
  }
  static TimePoint time_of(Word stamp) noexcept { return TimePoint{Duration{std::bit_cast<std::int64_t>(stamp)}}; }

  /// The status stands in the low half of its word, its complement in the high one. What no producer writes is Fault.
  static constexpr Word coded(LinkStatus status) noexcept {
    const Word number = std::to_underlying(status);
    return (~number << 32) | number;
  }
  static constexpr LinkStatus status_of(Word word) noexcept {
    const auto status = static_cast<LinkStatus>(word & 0xFFFF'FFFF);
    const bool written =
        status == LinkStatus::Valid || status == LinkStatus::Degraded || status == LinkStatus::Stopping;
    return written && word == coded(status) ? status : LinkStatus::Fault;
  }
};

}  // namespace hirosco::detail
