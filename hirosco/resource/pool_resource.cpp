// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/pool_resource.hpp"

#include <algorithm>

#include "hirosco/resource/pool_allocator.hpp"

namespace hirosco {

void* PoolResource::try_allocate(std::size_t octets, std::size_t alignment) noexcept {
  return pools_ != nullptr ? pools_->allocate(octets, std::max(alignment, block_alignment)) : nullptr;
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
  const auto* same = dynamic_cast<const PoolResource*>(&other);
  return same != nullptr && same->pools_ == pools_;
}

}  // namespace hirosco
