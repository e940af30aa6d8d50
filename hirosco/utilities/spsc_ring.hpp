// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace hirosco {

/// Distance that keeps two atomics from sharing a cache line.
inline constexpr std::size_t cache_line_octets = 64;

/// Queue of N values from one thread to one other; without N of as many as are said when it is made. Each end keeps its
/// own copy of the other end's position and looks again only when that copy says full (or empty), so that an undisturbed
/// transfer moves one cache line.
/// Realtime: wait-free, allocates nothing once constructed. Thread: one producer, one consumer; size() and dropped() any.
template <class T, std::size_t N = std::dynamic_extent>
class SpscRing {
  static constexpr bool sized = N != std::dynamic_extent;
  static_assert(std::is_trivially_copyable_v<T>, "values are copied between threads");
  static_assert(!sized || std::has_single_bit(N), "the length is a power of two");

 public:
  SpscRing()
    requires sized
  = default;
  /// Room for `length` values, at least one. Blocks: allocates.
  explicit SpscRing(std::size_t length)
    requires(!sized)
      : slots_(length != 0 ? length : 1) {}
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  /// False, and one more dropped(), when full. Thread: producer.
  bool try_push(const T& value) noexcept {
    const std::uint64_t head = producer_.position.load(std::memory_order_relaxed);
    if (head - producer_.other == capacity()) {
      producer_.other = consumer_.position.load(std::memory_order_acquire);
      if (head - producer_.other == capacity()) {
        dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
        return false;
      }
    }
    slots_[head % capacity()] = value;
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
    out = slots_[tail % capacity()];
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
    return head < tail ? 0 : static_cast<std::size_t>(head - tail < capacity() ? head - tail : capacity());
  }
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }
  [[nodiscard]] constexpr std::size_t capacity() const noexcept {
    if constexpr (sized) return N;
    else return slots_.size();
  }
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
  // Never sized anew: positions are places in it.
  alignas(cache_line_octets) std::conditional_t<sized, std::array<T, sized ? N : 0>, std::vector<T>> slots_{};
};

}  // namespace hirosco
