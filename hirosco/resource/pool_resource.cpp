// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/pool_resource.hpp"

#include <algorithm>

#include "hirosco/resource/pool_allocator.hpp"

namespace hirosco {

/// Counted before it looks which pools there are: who takes them away and then counts none knows that nobody has seen them.
class PoolResource::Call {
 public:
  explicit Call(PoolResource& resource) noexcept : resource_{resource} { resource_.calls_.fetch_add(1); }
  ~Call() { resource_.calls_.fetch_sub(1); }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  PoolResource& resource_;
};

void* PoolResource::try_allocate(std::size_t octets, std::size_t alignment) noexcept {
  const Call call{*this};
  BlockPools* const pools = give_.load();
  return pools != nullptr ? pools->allocate(octets, std::max(alignment, block_alignment)) : nullptr;
}

bool PoolResource::give_back(void* block) noexcept {
  const Call call{*this};
  BlockPools* const pools = take_back_.load();
  return pools != nullptr && pools->deallocate(block);
}

void PoolResource::open(BlockPools& pools) noexcept {
  take_back_.store(&pools);
  give_.store(&pools);
}

bool PoolResource::let_go() noexcept {
  BlockPools* const pools = take_back_.load();
  if (pools == nullptr) return true;
  if (calls_.load() != 0) return false;
  // No call from here on takes a block: what is held now is all that ever comes back.
  for (std::size_t i = 0; i < pools->size(); ++i)
    if (pools->usage(i).used != 0) return false;
  take_back_.store(nullptr);
  if (calls_.load() == 0) return true;
  // Somebody gives back what he does not hold, and may still look at these pools.
  take_back_.store(pools);
  return false;
}

void* PoolResource::do_allocate(std::size_t octets, std::size_t alignment) {
  void* const block = alignment <= max_block_alignment ? try_allocate(octets, alignment) : nullptr;
  if (block == nullptr) throw OutOfMemory(octets);
  return block;
}

void PoolResource::do_deallocate(void* block, std::size_t /*octets*/, std::size_t /*alignment*/) {
  static_cast<void>(give_back(block));
}

bool PoolResource::do_is_equal(const std::pmr::memory_resource& other) const noexcept {
  if (this == &other) return true;
  const auto* same = dynamic_cast<const PoolResource*>(&other);
  const BlockPools* const pools = take_back_.load();
  return same != nullptr && pools != nullptr && same->take_back_.load() == pools;
}

}  // namespace hirosco
