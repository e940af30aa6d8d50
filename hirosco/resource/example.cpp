// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Pools as a descriptor states them, and three ways to live in them.
#include <array>
#include <cstdio>
#include <vector>

#include "hirosco/resource/block_pools.hpp"
#include "hirosco/resource/counted.hpp"
#include "hirosco/resource/pool_allocator.hpp"

using namespace hirosco;

struct Image {
  std::array<std::byte, 1000> pixels{};
};

int main() {
  PoolNotices notices;
  notices.on_warning = [](std::size_t, const PoolUsage& usage) {
    std::printf("pool of %zu octets: %u of %u used\n", usage.block_octets, usage.used, usage.count);
  };
  auto pools = BlockPools::create(std::array{PoolSpec{64, 100}, PoolSpec{1024, 4}}, notices);
  if (!pools) return 1;

  void* const block = (*pools)->allocate(50);  // null would be a refusal
  (*pools)->deallocate(block);

  std::vector<int, PoolAllocator<int>> numbers{PoolAllocator<int>{**pools}};
  numbers.assign(10, 42);  // throws OutOfMemory when refused

  std::vector<Counted<Image>> images;
  while (auto image = make_counted<Image>(**pools))
    images.push_back(*image);  // warns at the third, ends after the fourth
  return images.size() == 4 ? 0 : 1;
}
