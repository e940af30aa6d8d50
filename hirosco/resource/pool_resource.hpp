// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory_resource>

#include "hirosco/resource/block_pools.hpp"

namespace hirosco {

/// Pools for the containers of std::pmr. What the pools refuse throws OutOfMemory, a std::bad_alloc: nothing is ever taken from
/// elsewhere. Its pools may come and go while it stays: without pools it refuses everything.
/// Realtime: lock-free, but a refusal throws. Thread: any. Outlives what was taken from it.
class PoolResource final : public std::pmr::memory_resource {
 public:
  explicit PoolResource(BlockPools* pools = nullptr) noexcept : give_{pools}, take_back_{pools} {}
  /// Null when refused: for who must not throw.  Realtime: lock-free. Thread: any.
  [[nodiscard]] void* try_allocate(std::size_t octets, std::size_t alignment = block_alignment) noexcept;
  /// Of what try_allocate() gave. False, and nothing happens, for what is no block in use.
  bool give_back(void* block) noexcept;

  // --- by who keeps the pools.  Thread: one --------------------------------------------------------------------------
  /// Gives blocks of these from now on; those of the pools before have been let go.
  void open(BlockPools& pools) noexcept;
  /// Gives none any more. What is held may still come back.
  void close() noexcept { give_.store(nullptr); }
  /// Behind close(): whether nobody knows these pools any more, so that they may end. Not so while a block is held, or a thread is in a
  /// call: then nothing has changed.
  [[nodiscard]] bool let_go() noexcept;

 private:
  class Call;
  void* do_allocate(std::size_t octets, std::size_t alignment) override;
  void do_deallocate(void* block, std::size_t octets, std::size_t alignment) override;
  [[nodiscard]] bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override;

  std::atomic<BlockPools*> give_;
  std::atomic<BlockPools*> take_back_;
  std::atomic<std::uint32_t> calls_{0};  ///< that are under way: pools do not end below them
};

}  // namespace hirosco
