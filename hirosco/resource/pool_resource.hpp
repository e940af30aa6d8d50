// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory_resource>

#include "hirosco/resource/block_pools.hpp"

namespace hirosco {

/// Pools for the containers of std::pmr. What the pools refuse throws OutOfMemory, a std::bad_alloc: nothing is ever taken from
/// elsewhere. Without pools it refuses everything.
/// Realtime: lock-free, but a refusal throws. Thread: any. Outlives what was taken from it.
class PoolResource final : public std::pmr::memory_resource {
 public:
  explicit PoolResource(BlockPools* pools = nullptr) noexcept : pools_{pools} {}
  /// Null: there are none.
  [[nodiscard]] BlockPools* pools() const noexcept { return pools_; }
  /// Null when refused: for who must not throw.  Realtime: lock-free. Thread: any.
  [[nodiscard]] void* try_allocate(std::size_t octets, std::size_t alignment = block_alignment) noexcept;
  /// Of what try_allocate() gave. False, and nothing happens, for what is no block in use.
  bool give_back(void* block) noexcept { return pools_ != nullptr && pools_->deallocate(block); }

 private:
  void* do_allocate(std::size_t octets, std::size_t alignment) override;
  void do_deallocate(void* block, std::size_t octets, std::size_t alignment) override;
  [[nodiscard]] bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override;

  BlockPools* pools_;
};

}  // namespace hirosco
