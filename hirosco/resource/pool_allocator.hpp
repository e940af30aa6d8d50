// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <new>
#include <type_traits>

#include "hirosco/resource/block_pools.hpp"

namespace hirosco {

/// Refusal of pools, in the form the standard containers expect. The pools' on_refusal has been called before.
class OutOfMemory final : public std::bad_alloc {
 public:
  explicit OutOfMemory(std::size_t octets) noexcept : octets_{octets} {}
  [[nodiscard]] const char* what() const noexcept override { return "no free block in the pools"; }
  [[nodiscard]] std::size_t octets() const noexcept { return octets_; }

 private:
  std::size_t octets_;
};

/// Lets standard containers and std::allocate_shared live in pools. Containers carry their pools along when moved or
/// swapped. A container that grows needs old and new storage at once: reserve() first.
/// Realtime and thread: as the pools.
template <class T, class Pools = BlockPools>
class PoolAllocator {
  static_assert(alignof(T) <= max_block_alignment);

 public:
  using value_type = T;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;
  using is_always_equal = std::false_type;
  template <class U>
  struct rebind {
    using other = PoolAllocator<U, Pools>;
  };

  explicit PoolAllocator(Pools& pools) noexcept : pools_{&pools} {}
  template <class U>
  PoolAllocator(const PoolAllocator<U, Pools>& other) noexcept : pools_{&other.pools()} {}

  /// Throws OutOfMemory when the pools refuse.
  [[nodiscard]] T* allocate(std::size_t count) {
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
    constexpr std::size_t alignment = alignof(T) > block_alignment ? alignof(T) : block_alignment;
    void* const block = pools_->allocate(count * sizeof(T), alignment);
    if (block == nullptr) throw OutOfMemory(count * sizeof(T));
    return static_cast<T*>(block);
  }
  void deallocate(T* block, std::size_t /*count*/) noexcept { (void)pools_->deallocate(static_cast<void*>(block)); }

  [[nodiscard]] Pools& pools() const noexcept { return *pools_; }
  template <class U>
  friend bool operator==(const PoolAllocator& a, const PoolAllocator<U, Pools>& b) noexcept {
    return &a.pools() == &b.pools();
  }

 private:
  Pools* pools_;
};

}  // namespace hirosco
