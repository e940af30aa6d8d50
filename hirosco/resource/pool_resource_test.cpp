// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/pool_resource.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory_resource>
#include <string>
#include <vector>

#include "hirosco/resource/counted.hpp"

namespace hirosco {
namespace {

struct PoolResourceTest : ::testing::Test {
  std::unique_ptr<BlockPools> pools = *BlockPools::create(std::array{PoolSpec{64, 4}, PoolSpec{1024, 1}});
  PoolResource resource{pools.get()};
};

TEST_F(PoolResourceTest, CarriesTheContainersOfStdPmr) {
  {
    std::pmr::vector<std::pmr::string> words{&resource};
    words.emplace_back("too long for the room inside of a string itself");
    EXPECT_EQ(pools->usage(0).used, 2U);
  }
  EXPECT_EQ(pools->usage(0).used, 0U);
}

TEST_F(PoolResourceTest, RefusesInTheWordsOfTheStandardWhatThePoolsRefuse) {
  EXPECT_THROW(static_cast<void>(resource.allocate(1025)), std::bad_alloc);
  EXPECT_THROW(static_cast<void>(resource.allocate(16, 128)), std::bad_alloc);
  EXPECT_EQ(resource.try_allocate(1025), nullptr);
  void* const block = resource.try_allocate(1024);
  ASSERT_NE(block, nullptr);
  EXPECT_EQ(resource.try_allocate(65), nullptr);
  EXPECT_TRUE(resource.give_back(block));
}

TEST_F(PoolResourceTest, WithoutPoolsEverythingIsRefused) {
  PoolResource none;
  EXPECT_EQ(none.try_allocate(1), nullptr);
  EXPECT_THROW(static_cast<void>(none.allocate(1)), std::bad_alloc);
}

TEST_F(PoolResourceTest, IsTheSameAsAnotherOnTheSamePools) {
  EXPECT_TRUE(resource.is_equal(PoolResource{pools.get()}));
  EXPECT_FALSE(resource.is_equal(PoolResource{}));
  const PoolResource none;
  EXPECT_TRUE(none.is_equal(none));
  EXPECT_FALSE(none.is_equal(PoolResource{}));
  EXPECT_FALSE(resource.is_equal(*std::pmr::new_delete_resource()));
}

TEST_F(PoolResourceTest, StaysWhileItsPoolsComeAndGo) {
  void* const held = resource.try_allocate(64);
  ASSERT_NE(held, nullptr);
  resource.close();
  EXPECT_EQ(resource.try_allocate(64), nullptr) << "it gives none any more";
  EXPECT_FALSE(resource.let_go()) << "a block is held, and its memory stays";
  EXPECT_TRUE(resource.give_back(held));
  EXPECT_TRUE(resource.let_go());
  EXPECT_TRUE(resource.let_go()) << "there is nothing more to let go";
  EXPECT_FALSE(resource.give_back(held)) << "nobody looks at pools that may have ended";
  pools = *BlockPools::create(std::array{PoolSpec{128, 1}});
  resource.open(*pools);
  EXPECT_NE(resource.try_allocate(128), nullptr);
}

TEST_F(PoolResourceTest, SharesCountedObjectsAndRefusesThemWithoutPools) {
  {
    const auto shared = make_counted<double>(resource, 2.5);
    ASSERT_TRUE(shared);
    const Counted<double> second = *shared;
    EXPECT_EQ(*second, 2.5);
    EXPECT_EQ(pools->usage(0).used, 1U);
  }
  EXPECT_EQ(pools->usage(0).used, 0U);
  resource.close();
  const auto refused = make_counted<double>(resource, 2.5);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
}

}  // namespace
}  // namespace hirosco
