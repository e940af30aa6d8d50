// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>

namespace hirosco {

/// Distance that keeps two atomics from sharing a cache line.
inline constexpr std::size_t cache_line_octets = 64;

/// Queue of N values from one thread to one other. Each end keeps its own copy of the other end's position and looks
/// again only when that copy says full (or empty), so that an undisturbed transfer moves one cache line.
/// Realtime: wait-free, allocates nothing. Thread: one producer, one consumer; size() and dropped() any.
template <class T, std::size_t N>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>, "values are copied between threads");
  static_assert(std::has_single_bit(N), "the length is a power of two");

 public:
  SpscRing() = default;
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  /// False, and one more dropped(), when full. Thread: producer.
  bool try_push(const T& value) noexcept {
    const std::uint64_t head = producer_.position.load(std::memory_order_relaxed);
    if (head - producer_.other == N) {
      producer_.other = consumer_.position.load(std::memory_order_acquire);
      if (head - producer_.other == N) {
        dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        return false;
      }
    }
    slots_[head % N] = value;
    producer_.position.store(head + 1, std::memory_order_release);
    return true;
  }

  /// False, and `out` unchanged, when empty. Thread: consumer.
  bool try_pop(T& out) noexcept {
    const std::uint64_t tail = consumer_.position.load(std::memory_order_relaxed);
    if (tail == consumer_.other) {
      consumer_.other = producer_.position.load(std::memory_order_acquire);
      if (tail == consumer_.other) return false;
    }
    out = slots_[tail % N];
    consumer_.position.store(tail + 1, std::memory_order_release);
    return true;
  }
  /// Thread: consumer.
  [[nodiscard]] std::optional<T> try_pop() noexcept
    requires std::is_default_constructible_v<T>
  {
    std::optional<T> value{std::in_place};
    if (!try_pop(*value)) value.reset();
    return value;
  }

  /// A moment's view: exact only while both ends rest.
  [[nodiscard]] std::size_t size() const noexcept {
    const std::uint64_t tail = consumer_.position.load(std::memory_order_acquire);
    const std::uint64_t head = producer_.position.load(std::memory_order_acquire);
    return head < tail ? 0 : static_cast<std::size_t>(head - tail < N ? head - tail : N);
  }
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }
  [[nodiscard]] static constexpr std::size_t capacity() noexcept { return N; }
  /// Values refused because the ring was full.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  /// Positions only grow; 64 bits do not wrap within any mission.
  struct alignas(cache_line_octets) End {
    std::atomic<std::uint64_t> position{0};
    std::uint64_t other{0};  ///< last seen position of the other end
  };

  End producer_;
  End consumer_;
  alignas(cache_line_octets) std::atomic<std::uint64_t> dropped_{0};
  alignas(cache_line_octets) std::array<T, N> slots_{};
};

}  // namespace hirosco
