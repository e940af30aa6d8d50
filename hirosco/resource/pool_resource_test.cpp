// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/pool_resource.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory_resource>
#include <string>
#include <vector>

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
  EXPECT_FALSE(resource.is_equal(*std::pmr::new_delete_resource()));
}

}  // namespace
}  // namespace hirosco
