// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/pool_allocator.hpp"

#include <gtest/gtest.h>

#include <array>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace hirosco {
namespace {

class PoolAllocatorTest : public ::testing::Test {
 protected:
  std::unique_ptr<BlockPools> pools_ =
      *BlockPools::create(std::array{PoolSpec{64, 200}, PoolSpec{256, 20}, PoolSpec{4096, 4}});
  [[nodiscard]] std::uint32_t used() const {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < pools_->size(); ++i) sum += pools_->usage(i).used;
    return sum;
  }
};

TEST_F(PoolAllocatorTest, StandardContainersLiveInPools) {
  {
    std::vector<int, PoolAllocator<int>> numbers{PoolAllocator<int>{*pools_}};
    for (int i = 0; i < 900; ++i) numbers.push_back(i);
    EXPECT_EQ(numbers[899], 899);
    std::list<int, PoolAllocator<int>> list({3, 1, 2}, PoolAllocator<int>{*pools_});
    list.sort();
    EXPECT_EQ(list.front(), 1);
    using Entry = std::pair<const int, int>;
    std::map<int, int, std::less<>, PoolAllocator<Entry>> map{PoolAllocator<Entry>{*pools_}};
    for (int i = 0; i < 50; ++i) map[i % 25] = i;
    EXPECT_EQ(map.size(), 25U);
    std::unordered_map<int, int, std::hash<int>, std::equal_to<>, PoolAllocator<Entry>> hashed{
        PoolAllocator<Entry>{*pools_}};
    for (int i = 0; i < 50; ++i) hashed[i] = i;
    EXPECT_EQ(hashed.at(49), 49);
    using Text = std::basic_string<char, std::char_traits<char>, PoolAllocator<char>>;
    Text text{"longer than what fits inside the object", PoolAllocator<char>{*pools_}};
    text += text;
    EXPECT_EQ(text.size(), 78U);
    EXPECT_GT(used(), 75U);
  }
  EXPECT_EQ(used(), 0U);
}

TEST_F(PoolAllocatorTest, MoveTakesThePoolsAlong) {
  const auto other = *BlockPools::create(std::array{PoolSpec{64, 4}});
  std::vector<int, PoolAllocator<int>> a({1, 2, 3}, PoolAllocator<int>{*pools_});
  std::vector<int, PoolAllocator<int>> b({4}, PoolAllocator<int>{*other});
  const int* const place = a.data();
  b = std::move(a);
  EXPECT_EQ(b.data(), place);
  EXPECT_EQ(other->usage(0).used, 0U);
  EXPECT_EQ(b.get_allocator(), PoolAllocator<double>{*pools_});
  EXPECT_NE(b.get_allocator(), PoolAllocator<int>{*other});
}

TEST_F(PoolAllocatorTest, RefusalFollowsTheStandardContract) {
  std::vector<char, PoolAllocator<char>> text{PoolAllocator<char>{*pools_}};
  text.resize(4096, 'x');
  try {
    text.resize(4097);
    FAIL() << "there is no such block";
  } catch (const std::bad_alloc& error) {
    EXPECT_STREQ(error.what(), "no free block in the pools");
  }
  EXPECT_EQ(text.size(), 4096U);
  EXPECT_EQ(text.back(), 'x');
  PoolAllocator<double> doubles{*pools_};
  EXPECT_THROW((void)doubles.allocate(~std::size_t{0} / 4), std::bad_array_new_length);
}

TEST_F(PoolAllocatorTest, AllocateSharedRunsOnPools) {
  std::weak_ptr<std::string> observer;
  {
    const auto shared = std::allocate_shared<std::string>(PoolAllocator<std::string>{*pools_}, "shared");
    observer = shared;
    EXPECT_EQ(used(), 1U);
  }
  EXPECT_TRUE(observer.expired());
  observer.reset();
  EXPECT_EQ(used(), 0U);
}

}  // namespace
}  // namespace hirosco
