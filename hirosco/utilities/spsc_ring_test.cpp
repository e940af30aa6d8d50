// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/spsc_ring.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

namespace hirosco {
namespace {

TEST(SpscRing, GivesValuesBackInTheirOrder) {
  SpscRing<int, 4> ring;
  for (int lap = 0; lap < 10; ++lap) {
    EXPECT_TRUE(ring.try_push(3 * lap));
    EXPECT_TRUE(ring.try_push(3 * lap + 1));
    EXPECT_TRUE(ring.try_push(3 * lap + 2));
    EXPECT_EQ(ring.size(), 3U);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(ring.try_pop(), 3 * lap + i);
  }
  EXPECT_TRUE(ring.empty());
}

TEST(SpscRing, HoldsItsFullLengthAndCountsWhatItRefuses) {
  SpscRing<int, 4> ring;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.try_push(i));
  EXPECT_FALSE(ring.try_push(4));
  EXPECT_FALSE(ring.try_push(5));
  EXPECT_EQ(ring.dropped(), 2U);
  EXPECT_EQ(ring.try_pop(), 0);
  EXPECT_TRUE(ring.try_push(6));
  EXPECT_EQ(ring.size(), ring.capacity());
}

TEST(SpscRing, HoldsAsManyAsWereSaidWhenItWasMade) {
  SpscRing<int> ring{3};
  EXPECT_EQ(ring.capacity(), 3U);
  for (int lap = 0; lap < 5; ++lap) {
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(ring.try_push(10 * lap + i));
    EXPECT_FALSE(ring.try_push(99));
    EXPECT_EQ(ring.size(), 3U);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(ring.try_pop(), 10 * lap + i);
    EXPECT_EQ(ring.try_pop(), std::nullopt);
  }
  EXPECT_EQ(ring.dropped(), 5U);
}

TEST(SpscRing, LeavesTheValueAloneWhenEmpty) {
  SpscRing<int, 2> ring;
  int value = 42;
  EXPECT_FALSE(ring.try_pop(value));
  EXPECT_EQ(value, 42);
  EXPECT_EQ(ring.try_pop(), std::nullopt);
}

TEST(SpscRing, TransfersBetweenThreadsWithoutLossOrDamage) {
  struct Sample {
    std::uint64_t number;
    std::uint64_t inverse;
  };
  constexpr std::uint64_t count = 300'000;
  const auto ring = std::make_unique<SpscRing<Sample, 64>>();
  std::thread producer{[&] {
    for (std::uint64_t i = 0; i < count;) {
      if (ring->try_push({i, ~i})) ++i;
      else std::this_thread::yield();
    }
  }};
  std::uint64_t wrong = 0;
  for (std::uint64_t expected = 0; expected < count;) {
    Sample sample{};
    if (!ring->try_pop(sample)) {
      std::this_thread::yield();
      continue;
    }
    if (sample.number != expected || sample.inverse != ~expected) ++wrong;
    ++expected;
  }
  producer.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_TRUE(ring->empty());
}

}  // namespace
}  // namespace hirosco
