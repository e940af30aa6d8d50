// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "hirosco/resource/pool_resource.hpp"

namespace hirosco {
namespace {

TEST(SharedPool, KeepsItsBlocksWholeUnderFourThreads) {
  constexpr std::uint32_t thread_count = 4;
  constexpr std::uint32_t held_each = 10;
  const auto pools = *BlockPools::create(std::array{PoolSpec{64, thread_count * held_each}});
  std::atomic<std::uint32_t> wrong{0};
  const auto work = [&](std::uint32_t self) {
    std::array<std::uint32_t*, held_each> mine{};
    for (std::uint32_t round = 0; round < 20'000; ++round) {
      std::uint32_t*& place = mine[round % held_each];
      if (place != nullptr && (*place != (self << 24 | (round - held_each)) || !pools->deallocate(place))) ++wrong;
      place = static_cast<std::uint32_t*>(pools->allocate(64));
      if (place == nullptr) ++wrong;
      else *place = self << 24 | round;
    }
    for (std::uint32_t* place : mine)
      if (!pools->deallocate(place)) ++wrong;
  };
  std::vector<std::thread> threads;
  for (std::uint32_t i = 0; i < thread_count; ++i) threads.emplace_back(work, i);
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(pools->usage(0).used, 0U);
  EXPECT_EQ(pools->refused(), 0U);
  EXPECT_LE(pools->usage(0).high_water, thread_count * held_each);
}

/// Four threads take and give back without an end while their pools come and go: none of them meets a pool that has ended.
TEST(SharedPool, EndsUnderNobodyWhoseCallIsUnderWay) {
  PoolResource resource;
  std::atomic<bool> enough{false};
  std::atomic<std::uint32_t> wrong{0};
  const auto work = [&] {
    while (!enough.load()) {
      auto* const block = static_cast<std::uint32_t*>(resource.try_allocate(64));
      if (block == nullptr) {
        // For who waits until nobody is in a call.
        std::this_thread::yield();
        continue;
      }
      *block = 1;
      if (!resource.give_back(block)) ++wrong;
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) threads.emplace_back(work);
  for (int turn = 0; turn < 200; ++turn) {
    auto pools = *BlockPools::create(std::array{PoolSpec{64, 4}});
    resource.open(*pools);
    while (pools->usage(0).high_water == 0) std::this_thread::yield();
    resource.close();
    while (!resource.let_go()) std::this_thread::yield();
    EXPECT_EQ(pools->usage(0).used, 0U);
  }
  enough = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace hirosco
