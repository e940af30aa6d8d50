// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "hirosco/resource/free_list.hpp"
#include "hirosco/utilities/os/private_memory.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// One pool as the descriptor states it.
struct PoolSpec {
  std::size_t block_octets{};  ///< rounded up to a multiple of 16
  std::size_t count{};
};

struct PoolUsage {
  std::size_t block_octets{};
  std::uint32_t count{};
  std::uint32_t used{};
  std::uint32_t high_water{};  ///< most blocks in use at once since the start
};

/// What the owner of pools wants to hear. Both are called by the thread that allocates, possibly in its cycle: they must
/// neither block nor use the heap or these pools.
struct PoolNotices {
  unsigned warning_percent{75};  ///< 1..100, 0 = no warning
  /// A pool's use reached the warning level from below: once per crossing.
  std::function<void(std::size_t pool, const PoolUsage&)> on_warning{};
  /// A request found no block.
  std::function<void(std::size_t octets)> on_refusal{};
};

inline constexpr std::size_t max_pools = 16;
/// Alignment of every block.
inline constexpr std::size_t block_alignment = 16;
/// Strictest alignment that can be asked for; met by pools whose blocks are a multiple of it.
inline constexpr std::size_t max_block_alignment = 64;

namespace detail {

[[nodiscard]] constexpr std::size_t rounded_up(std::size_t value, std::size_t multiple) noexcept {
  return (value + multiple - 1) / multiple * multiple;
}

struct PoolPlan {
  std::vector<PoolSpec> pools;  ///< ascending block sizes, rounded
  std::size_t octets{0};  ///< of all blocks, each pool rounded up to max_block_alignment
  std::size_t arena_octets{0};  ///< with what stands beside the blocks
};
/// Refuses no pools, empty ones, two of one size and sizes beyond counting. `link_octets`: what stands beside each block.
[[nodiscard]] Result<PoolPlan> plan_pools(std::span<const PoolSpec> specs, unsigned warning_percent,
                                          std::size_t link_octets);

}  // namespace detail

/// Pools of fixed blocks of several sizes, allocated once and never grown (paper 4.1). A request takes a block of the
/// smallest size that fits and has one free; then the next larger; then it is refused. Their memory is the system's, in RAM from the
/// begin, and goes back to it with them.
/// Realtime: allocate() and deallocate() are lock-free (local: wait-free) and never ask the operating system.
/// Thread: any (local: one). The pools outlive all that was taken from them.
template <class FreeList>
class BasicBlockPools {
 public:
  /// Pools are numbered by ascending block size.
  [[nodiscard]] static Result<std::unique_ptr<BasicBlockPools>> create(std::span<const PoolSpec> specs,
                                                                       PoolNotices notices = {});
  BasicBlockPools(const BasicBlockPools&) = delete;
  BasicBlockPools& operator=(const BasicBlockPools&) = delete;

  /// Null when refused: nothing that fits is free. `alignment` is a power of two up to max_block_alignment.
  [[nodiscard]] void* allocate(std::size_t octets, std::size_t alignment = block_alignment) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      Pool& pool = pools_[i];
      if (pool.block_octets < octets || (pool.block_octets & (alignment - 1)) != 0) continue;
      std::uint32_t used = 0;
      if (void* const block = pool.free.take(used)) {
        note_use(i, used);
        return block;
      }
    }
    return refuse(octets);
  }

  /// False, and nothing happens, for what is not a block of these pools (shared pools: in use). Null is ignored.
  bool deallocate(void* block) noexcept {
    if (block == nullptr) return true;
    for (std::size_t i = 0; i < count_; ++i) {
      // Cheaper than the question whose block's start it is, which is asked of one pool only.
      if (reinterpret_cast<std::uintptr_t>(block) - pools_[i].begins_at >= pools_[i].octets) continue;
      std::uint32_t used = 0;
      if (!pools_[i].free.give_back(block, used)) return false;
      if (used < pools_[i].warning_at && pools_[i].warned.load(std::memory_order_relaxed))
        pools_[i].warned.store(false, std::memory_order_relaxed);
      return true;
    }
    return false;
  }

  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  /// `pool` < size(). Exact while no other thread allocates.
  [[nodiscard]] PoolUsage usage(std::size_t pool) const noexcept {
    const Pool& of = pools_[pool];
    return {of.block_octets, of.free.row().count(), of.free.used(), of.high_water.load(std::memory_order_relaxed)};
  }
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_.load(std::memory_order_relaxed); }
  /// Octets of all blocks: constant.
  [[nodiscard]] std::size_t total_octets() const noexcept { return total_octets_; }
  [[nodiscard]] std::size_t largest_block() const noexcept { return pools_[count_ - 1].block_octets; }

 private:
  struct Pool {
    std::size_t block_octets{};
    std::uintptr_t begins_at{0};
    std::size_t octets{0};  ///< of all its blocks
    std::uint32_t warning_at{};  ///< blocks in use
    std::atomic<std::uint32_t> high_water{0};
    std::atomic<bool> warned{false};
    FreeList free;
  };

  explicit BasicBlockPools(PoolNotices notices) : notices_{std::move(notices)} {}

  void note_use(std::size_t index, std::uint32_t used) noexcept {
    Pool& pool = pools_[index];
    std::uint32_t high = pool.high_water.load(std::memory_order_relaxed);
    while (used > high && !pool.high_water.compare_exchange_weak(high, used, std::memory_order_relaxed)) {}
    if (used < pool.warning_at || pool.warned.load(std::memory_order_relaxed)) return;
    if (pool.warned.exchange(true, std::memory_order_relaxed)) return;
    if (notices_.on_warning) notices_.on_warning(index, usage(index));
  }

  void* refuse(std::size_t octets) noexcept {
    refused_.fetch_add(1, std::memory_order_relaxed);
    if (notices_.on_refusal) notices_.on_refusal(octets);
    return nullptr;
  }

  PoolNotices notices_;
  PrivateMemory arena_;
  std::unique_ptr<Pool[]> pools_;
  std::size_t count_{0};
  std::size_t total_octets_{0};
  std::atomic<std::uint64_t> refused_{0};
};

template <class FreeList>
Result<std::unique_ptr<BasicBlockPools<FreeList>>> BasicBlockPools<FreeList>::create(std::span<const PoolSpec> specs,
                                                                                     PoolNotices notices) {
  HIROSCO_TRY_LET(const detail::PoolPlan plan,
                  detail::plan_pools(specs, notices.warning_percent, FreeList::link_octets));
  const std::size_t percent = notices.warning_percent;
  std::unique_ptr<BasicBlockPools> made{new BasicBlockPools(std::move(notices))};
  auto arena = PrivateMemory::take(plan.arena_octets);
  if (!arena) return fail(ErrorCode::ResourceExhausted, "memory for pools", arena.error().value);
  made->arena_ = std::move(*arena);
  made->pools_ = std::make_unique<Pool[]>(plan.pools.size());
  made->count_ = plan.pools.size();
  made->total_octets_ = plan.octets;
  std::byte* start = made->arena_.octets().data();
  std::byte* links = start + plan.octets;
  for (std::size_t i = 0; i < plan.pools.size(); ++i) {
    const PoolSpec& spec = plan.pools[i];
    const MutableOctets memory{start, spec.block_octets * spec.count};
    made->pools_[i].block_octets = spec.block_octets;
    made->pools_[i].begins_at = reinterpret_cast<std::uintptr_t>(start);
    made->pools_[i].octets = memory.size();
    made->pools_[i].warning_at =
        percent == 0 ? ~std::uint32_t{0}
                     : static_cast<std::uint32_t>(std::max<std::size_t>(1, (spec.count * percent + 99) / 100));
    made->pools_[i].free.build(BlockRow{memory, spec.block_octets, static_cast<std::uint32_t>(spec.count)},
                               {links, FreeList::link_octets * spec.count});
    start += detail::rounded_up(memory.size(), max_block_alignment);
    links += FreeList::link_octets * spec.count;
  }
  return made;
}

/// Pools used by any thread.
using BlockPools = BasicBlockPools<SharedFreeList>;
/// Pools used by one thread: several times faster.
using LocalBlockPools = BasicBlockPools<LocalFreeList>;

}  // namespace hirosco
