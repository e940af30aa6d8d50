// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/spsc_ring.hpp"

namespace hirosco {

/// Largest number of blocks in one pool.
inline constexpr std::size_t max_blocks_of_pool = std::numeric_limits<std::uint32_t>::max() - 2;

/// Equal blocks side by side: which one starts at an address. Divides by multiplying with the inverse modulo 2^64,
/// which also tells an address that is no block's start.  Realtime: wait-free. Thread: any.
class BlockRow {
 public:
  BlockRow() = default;
  BlockRow(MutableOctets memory, std::size_t block_octets, std::uint32_t count) noexcept;

  [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
  [[nodiscard]] std::byte* block(std::uint32_t index) const noexcept { return start_ + index * block_octets_; }
  [[nodiscard]] std::optional<std::uint32_t> index_of(const void* address) const noexcept {
    // Below the start this wraps to a huge offset, which no index matches.
    const std::uint64_t offset = reinterpret_cast<std::uintptr_t>(address) - reinterpret_cast<std::uintptr_t>(start_);
    const std::uint64_t index = std::rotr(offset * inverse_, twos_);
    if (index >= count_) return std::nullopt;
    return static_cast<std::uint32_t>(index);
  }

 private:
  std::byte* start_{nullptr};
  std::size_t block_octets_{1};
  std::uint64_t inverse_{1};  ///< of the odd part of block_octets_, modulo 2^64
  int twos_{0};               ///< factors 2 in block_octets_
  std::uint32_t count_{0};
};

/// Free blocks of one pool, used by any thread: a stack of indices whose head carries a tag that every take changes, so
/// that a head that looks the same is the same. Links stand beside the blocks, never in them: a late reader of a link
/// must not meet a new owner's data.
/// Realtime: lock-free. Thread: any.
class SharedFreeList {
 public:
  /// What it wants beside each block.
  static constexpr std::size_t link_octets = sizeof(std::atomic<std::uint32_t>);
  /// `links`: link_octets for each block, aligned like them, for as long as it lives.
  void build(const BlockRow& row, MutableOctets links);
  /// Null when none is free; otherwise `used` is the number in use now, which under contention may be ahead of or behind
  /// other threads' calls in progress.
  [[nodiscard]] void* take(std::uint32_t& used) noexcept {
    std::uint64_t head = head_.load(std::memory_order_acquire);
    for (;;) {
      const std::uint32_t index = index_in(head);
      if (index == none) return nullptr;
      const std::uint32_t given_back = given_back_.load(std::memory_order_relaxed);
      // May be stale when another thread took this block meanwhile; then the tag differs and the exchange fails.
      const std::uint32_t next = next_[index].load(std::memory_order_relaxed);
      const std::uint32_t taken_now = tag_in(head) + 1;
      if (!head_.compare_exchange_weak(head, head_of(taken_now, next), std::memory_order_acquire)) continue;
      next_[index].store(in_use, std::memory_order_relaxed);
      used = used_of(taken_now, given_back);
      return row_.block(index);
    }
  }
  /// False, and nothing happens, for an address that is not a block in use.
  [[nodiscard]] bool give_back(void* address, std::uint32_t& used) noexcept {
    const std::optional<std::uint32_t> index = row_.index_of(address);
    if (!index) return false;
    // Not an exchange: two threads that give back one block at the same moment are beyond what this has to notice.
    if (next_[*index].load(std::memory_order_relaxed) != in_use) return false;
    const std::uint32_t given_back = given_back_.fetch_add(1, std::memory_order_release) + 1;
    std::uint64_t head = head_.load(std::memory_order_relaxed);
    do {
      next_[*index].store(index_in(head), std::memory_order_relaxed);
    } while (!head_.compare_exchange_weak(head, head_of(tag_in(head), *index), std::memory_order_release,
                                          std::memory_order_relaxed));
    used = used_of(tag_in(head), given_back);
    return true;
  }
  [[nodiscard]] std::uint32_t used() const noexcept {
    const std::uint32_t given_back = given_back_.load(std::memory_order_acquire);
    return used_of(tag_in(head_.load(std::memory_order_acquire)), given_back);
  }
  [[nodiscard]] const BlockRow& row() const noexcept { return row_; }

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t in_use = none - 1;

  [[nodiscard]] static std::uint32_t index_in(std::uint64_t head) noexcept { return static_cast<std::uint32_t>(head); }
  /// The tag counts takes, modulo 2^32; given_back_ counts the other direction.
  [[nodiscard]] static std::uint32_t tag_in(std::uint64_t head) noexcept {
    return static_cast<std::uint32_t>(head >> 32);
  }
  [[nodiscard]] static std::uint64_t head_of(std::uint32_t tag, std::uint32_t index) noexcept {
    return std::uint64_t{tag} << 32 | index;
  }
  /// Calls in progress may put the difference out of 0..count for a moment.
  [[nodiscard]] std::uint32_t used_of(std::uint32_t taken, std::uint32_t given_back) const noexcept {
    const auto difference = static_cast<std::int32_t>(taken - given_back);
    if (row_.count() <= std::numeric_limits<std::int32_t>::max() && difference < 0) return 0;
    return taken - given_back < row_.count() ? taken - given_back : row_.count();
  }

  BlockRow row_;
  std::atomic<std::uint32_t>* next_{nullptr};
  alignas(cache_line_octets) std::atomic<std::uint64_t> head_{none};
  alignas(cache_line_octets) std::atomic<std::uint32_t> given_back_{0};
};

/// Free blocks of one pool, used by one thread: links stand in the free blocks, the last given back is the next taken.
/// Realtime: wait-free. Thread: one.
class LocalFreeList {
 public:
  static constexpr std::size_t link_octets = 0;
  void build(const BlockRow& row, MutableOctets links);
  [[nodiscard]] void* take(std::uint32_t& used) noexcept {
    if (first_ == nullptr) return nullptr;
    Link* const link = first_;
    first_ = link->next;
    used = ++used_;
    return link;
  }
  /// False, and nothing happens, for an address that is no block's. A block given back twice is not noticed.
  [[nodiscard]] bool give_back(void* address, std::uint32_t& used) noexcept {
    if (!row_.index_of(address) || used_ == 0) return false;
    first_ = new (address) Link{first_};
    used = --used_;
    return true;
  }
  [[nodiscard]] std::uint32_t used() const noexcept { return used_; }
  [[nodiscard]] const BlockRow& row() const noexcept { return row_; }

 private:
  struct Link {
    Link* next;
  };
  BlockRow row_;
  Link* first_{nullptr};
  std::uint32_t used_{0};
};

}  // namespace hirosco
