// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/block_pools.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>
#include <vector>

#include "hirosco/utilities/allocation_guard.hpp"
#include "hirosco/utilities/testing/slice.hpp"

namespace hirosco {
namespace {

template <class Pools>
class Pool : public ::testing::Test {
 protected:
  static std::unique_ptr<Pools> make(std::vector<PoolSpec> specs, PoolNotices notices = {}) {
    auto made = Pools::create(specs, std::move(notices));
    EXPECT_TRUE(made) << made.error().text;
    return made ? std::move(*made) : nullptr;
  }
};
using BothPools = ::testing::Types<BlockPools, LocalBlockPools>;
TYPED_TEST_SUITE(Pool, BothPools);

TYPED_TEST(Pool, TakesTheSmallestBlockThatFits) {
  const auto pools = this->make({{256, 2}, {64, 2}, {16, 2}});
  ASSERT_EQ(pools->size(), 3U);
  (void)pools->allocate(17);
  EXPECT_EQ(pools->usage(0).used, 0U);
  EXPECT_EQ(pools->usage(1).used, 1U);
  EXPECT_EQ(pools->usage(1).block_octets, 64U);
  (void)pools->allocate(16);
  (void)pools->allocate(0);
  EXPECT_EQ(pools->usage(0).used, 2U);
  (void)pools->allocate(256);
  EXPECT_EQ(pools->usage(2).used, 1U);
}

TYPED_TEST(Pool, FallsUpToLargerBlocksAndThenRefuses) {
  std::size_t refused = 0;
  PoolNotices notices;
  notices.on_refusal = [&](std::size_t octets) { refused = octets; };
  const auto pools = this->make({{16, 1}, {64, 1}}, std::move(notices));
  EXPECT_NE(pools->allocate(8), nullptr);
  EXPECT_NE(pools->allocate(8), nullptr);
  EXPECT_EQ(pools->usage(1).used, 1U);
  EXPECT_EQ(pools->allocate(8), nullptr);
  EXPECT_EQ(refused, 8U);
  EXPECT_EQ(pools->refused(), 1U);
}

TYPED_TEST(Pool, RefusesWhatIsLargerThanItsLargestBlock) {
  const auto pools = this->make({{64, 4}});
  EXPECT_EQ(pools->allocate(65), nullptr);
  EXPECT_EQ(pools->allocate(std::size_t{0} - 1), nullptr);
  EXPECT_NE(pools->allocate(pools->largest_block()), nullptr);
}

TYPED_TEST(Pool, BlocksDoNotOverlapAndAreAligned) {
  const auto pools = this->make({{48, 7}, {100, 5}, {64, 3}});
  std::vector<std::pair<std::byte*, std::size_t>> blocks;
  for (const std::size_t octets : {48UZ, 112UZ, 64UZ})
    while (auto* block = static_cast<std::byte*>(pools->allocate(octets))) {
      std::memset(block, static_cast<int>(blocks.size()), octets);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % block_alignment, 0U);
      blocks.emplace_back(block, octets);
    }
  EXPECT_EQ(blocks.size(), 15U);
  for (std::size_t i = 0; i < blocks.size(); ++i)
    for (std::size_t at = 0; at < blocks[i].second; ++at) ASSERT_EQ(blocks[i].first[at], static_cast<std::byte>(i));
}

TYPED_TEST(Pool, MeetsStricterAlignmentFromPoolsThatHaveIt) {
  const auto pools = this->make({{48, 4}, {192, 2}});
  void* const block = pools->allocate(10, 64);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 64, 0U);
  EXPECT_EQ(pools->usage(0).used, 0U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pools->allocate(10, 64)) % 64, 0U);
  EXPECT_EQ(pools->allocate(10, 64), nullptr);
}

TYPED_TEST(Pool, WarnsOncePerCrossingWithThePoolNamed) {
  std::vector<std::pair<std::size_t, std::uint32_t>> warnings;
  PoolNotices notices;
  notices.on_warning = [&](std::size_t pool, const PoolUsage& usage) { warnings.emplace_back(pool, usage.used); };
  const auto pools = this->make({{16, 100}, {32, 8}}, std::move(notices));
  std::vector<void*> blocks;
  for (int i = 0; i < 5; ++i) blocks.push_back(pools->allocate(32));
  EXPECT_TRUE(warnings.empty());
  for (int i = 0; i < 3; ++i) blocks.push_back(pools->allocate(32));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0], (std::pair<std::size_t, std::uint32_t>{1, 6}));
  for (int i = 0; i < 2; ++i) pools->deallocate(blocks[static_cast<std::size_t>(i)]);
  (void)pools->allocate(32);
  EXPECT_EQ(warnings.size(), 1U) << "6 of 8 is not below the level";
  for (int i = 2; i < 4; ++i) pools->deallocate(blocks[static_cast<std::size_t>(i)]);
  (void)pools->allocate(32);
  EXPECT_EQ(warnings.size(), 2U);
}

TYPED_TEST(Pool, WarningLevelIsConfigurableAndCanBeOff) {
  unsigned at_half = 0;
  unsigned off = 0;
  const auto half =
      this->make({{16, 10}}, {.warning_percent = 50, .on_warning = [&](auto, const auto& u) { at_half = u.used; }});
  const auto none = this->make({{16, 10}}, {.warning_percent = 0, .on_warning = [&](auto, const auto&) { ++off; }});
  for (int i = 0; i < 10; ++i) {
    (void)half->allocate(1);
    (void)none->allocate(1);
  }
  EXPECT_EQ(at_half, 5U);
  EXPECT_EQ(off, 0U);
}

TYPED_TEST(Pool, RemembersItsHighWaterMark) {
  const auto pools = this->make({{16, 10}});
  std::array<void*, 7> blocks{};
  for (void*& block : blocks) block = pools->allocate(1);
  for (void* block : blocks) EXPECT_TRUE(pools->deallocate(block));
  EXPECT_EQ(pools->usage(0).used, 0U);
  EXPECT_EQ(pools->usage(0).high_water, 7U);
}

TYPED_TEST(Pool, GivesBackOnlyWhatIsItsOwn) {
  const auto pools = this->make({{48, 4}});
  auto* const block = static_cast<std::byte*>(pools->allocate(48));
  int foreign = 0;
  EXPECT_FALSE(pools->deallocate(&foreign));
  EXPECT_FALSE(pools->deallocate(block + 16));
  EXPECT_EQ(pools->usage(0).used, 1U);
  EXPECT_TRUE(pools->deallocate(nullptr));
  EXPECT_TRUE(pools->deallocate(block));
}

TEST(SharedPool, RefusesABlockGivenBackTwice) {
  const auto pools = *BlockPools::create(std::array{PoolSpec{48, 4}});
  void* const block = pools->allocate(48);
  EXPECT_TRUE(pools->deallocate(block));
  EXPECT_FALSE(pools->deallocate(block));
  EXPECT_EQ(pools->usage(0).used, 0U);
}

TYPED_TEST(Pool, RefusesPoolsThatHaveNoMeaning) {
  const auto error = [](std::vector<PoolSpec> specs, PoolNotices notices = {}) {
    auto made = TypeParam::create(specs, std::move(notices));
    return made ? ErrorCode::Internal : made.error().code;
  };
  EXPECT_EQ(error({}), ErrorCode::InvalidArgument);
  EXPECT_EQ(error({{0, 1}}), ErrorCode::InvalidArgument);
  EXPECT_EQ(error({{16, 0}}), ErrorCode::InvalidArgument);
  EXPECT_EQ(error({{16, std::size_t{1} << 40}}), ErrorCode::InvalidArgument);
  EXPECT_EQ(error({{std::size_t{0} - 1, 2}}), ErrorCode::InvalidArgument);
  EXPECT_EQ(error({{17, 1}, {32, 1}}), ErrorCode::AlreadyExists);
  EXPECT_EQ(error(std::vector<PoolSpec>(max_pools + 1, {16, 1})), ErrorCode::InvalidArgument);
  EXPECT_EQ(error({{16, 1}}, {.warning_percent = 101}), ErrorCode::OutOfRange);
}

TYPED_TEST(Pool, IsNeverRefusedIn1e7MixedOperationsAt95PercentWhileBlocksAreFree) {
  constexpr std::size_t pool_count = 4;
  constexpr std::uint32_t blocks_each = 1000;
  constexpr std::array<std::size_t, pool_count> sizes{32, 128, 512, 2048};
  const auto pools =
      this->make({{sizes[0], blocks_each}, {sizes[1], blocks_each}, {sizes[2], blocks_each}, {sizes[3], blocks_each}});
  const std::size_t octets_before = pools->total_octets();
  std::mt19937 random{7};
  std::array<std::vector<void*>, pool_count> held;
  const auto take = [&](std::size_t pool) {
    const std::size_t smallest = pool == 0 ? 1 : sizes[pool - 1] + 1;
    void* const block = pools->allocate(smallest + random() % (sizes[pool] - smallest + 1));
    ASSERT_NE(block, nullptr);
    held[pool].push_back(block);
  };
  for (auto& blocks : held) blocks.reserve(blocks_each);
  for (std::size_t pool = 0; pool < pool_count; ++pool)
    for (std::uint32_t i = 0; i < blocks_each * 95 / 100; ++i) take(pool);

  const RealtimeScope scope;
  const int pairs = 5'000'000 / hirosco::testing::one_in(10);
  for (int i = 0; i < pairs && !this->HasFatalFailure(); ++i) {
    const std::size_t pool = random() % pool_count;
    void*& victim = held[pool][random() % held[pool].size()];
    std::swap(victim, held[pool].back());
    ASSERT_TRUE(pools->deallocate(held[pool].back()));
    held[pool].pop_back();
    take(pool);
  }
  EXPECT_EQ(scope.count().allocations, 0U);
  EXPECT_EQ(pools->refused(), 0U);
  EXPECT_EQ(pools->total_octets(), octets_before);
  for (std::size_t pool = 0; pool < pool_count; ++pool) {
    EXPECT_EQ(pools->usage(pool).used, 950U);
    EXPECT_EQ(pools->usage(pool).high_water, 950U) << "each request was served from its own size";
  }
}

TEST(BlockRow, FindsEveryBlockAndNothingElse) {
  for (const std::size_t octets : {16U, 48U, 112U, 4096U, 1008U}) {
    std::vector<std::byte> memory(octets * 9);
    const BlockRow row{memory, octets, 9};
    for (std::size_t at = 0; at < memory.size(); ++at) {
      const auto index = row.index_of(memory.data() + at);
      if (at % octets == 0) EXPECT_EQ(index, at / octets);
      else EXPECT_EQ(index, std::nullopt) << octets << " " << at;
    }
    EXPECT_FALSE(row.index_of(memory.data() + memory.size()));
    // NOLINTNEXTLINE(performance-no-int-to-ptr): pointer arithmetic may not leave the array
    EXPECT_FALSE(row.index_of(reinterpret_cast<std::byte*>(reinterpret_cast<std::uintptr_t>(memory.data()) - octets)));
  }
}

}  // namespace
}  // namespace hirosco
