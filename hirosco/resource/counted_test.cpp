// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/resource/counted.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace hirosco {
namespace {

class CountedTest : public ::testing::Test {
 protected:
  std::unique_ptr<BlockPools> pools_ = *BlockPools::create(std::array{PoolSpec{128, 8}});
  [[nodiscard]] std::uint32_t used() const { return pools_->usage(0).used; }
};

struct Base {
  virtual ~Base() = default;
  [[nodiscard]] virtual int number() const { return 1; }
};
class Derived final : public Base {
 public:
  explicit Derived(int& destroyed) : destroyed_{destroyed} {}
  ~Derived() override { ++destroyed_; }
  [[nodiscard]] int number() const override { return 2; }

 private:
  int& destroyed_;
};

TEST_F(CountedTest, LastOwnerDestroysTheObjectAndGivesTheBlockBack) {
  int destroyed = 0;
  Counted<Derived> first = *make_counted<Derived>(*pools_, destroyed);
  {
    const Counted<Derived> second = first;  // NOLINT(performance-unnecessary-copy-initialization): a second owner
    EXPECT_EQ(first.owners(), 2U);
    EXPECT_EQ(second, first);
  }
  EXPECT_EQ(destroyed, 0);
  EXPECT_EQ(used(), 1U);
  first.reset();
  EXPECT_EQ(destroyed, 1);
  EXPECT_EQ(used(), 0U);
  EXPECT_FALSE(first);
}

TEST_F(CountedTest, MovesWithoutCounting) {
  Counted<std::string> first = *make_counted<std::string>(*pools_, "text");
  Counted<std::string> second = std::move(first);
  EXPECT_EQ(second.owners(), 1U);
  EXPECT_EQ(*second, "text");
  first = second;
  EXPECT_EQ(first->size(), 4U);
  EXPECT_EQ(first.owners(), 2U);
  Counted<std::string>& same = first;
  first = same;
  EXPECT_EQ(first.owners(), 2U);
}

TEST_F(CountedTest, ConvertsToBaseAndToConst) {
  int destroyed = 0;
  {
    Counted<Base> base = *make_counted<Derived>(*pools_, destroyed);
    const Counted<const Base> constant = base;
    EXPECT_EQ(constant->number(), 2);
    EXPECT_EQ(base.owners(), 2U);
  }
  EXPECT_EQ(destroyed, 1);
  EXPECT_EQ(used(), 0U);
}

TEST_F(CountedTest, RefusesWhenThePoolsAreFull) {
  std::vector<Counted<int>> held;
  for (int i = 0; i < 8; ++i) held.push_back(*make_counted<int>(*pools_, i));
  const auto refused = make_counted<int>(*pools_, 9);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
  held.pop_back();
  EXPECT_TRUE(make_counted<int>(*pools_, 9));
}

TEST_F(CountedTest, AConstructorThatThrowsKeepsNoBlock) {
  struct Thrower {
    Thrower() { throw std::runtime_error("no"); }
  };
  EXPECT_THROW((void)make_counted<Thrower>(*pools_), std::runtime_error);
  EXPECT_EQ(used(), 0U);
}

TEST_F(CountedTest, IsSharedByFourThreads) {
  constexpr int rounds = 5000;
  std::atomic<int> wrong{0};
  for (int lap = 0; lap < 4; ++lap) {
    Counted<std::array<int, 16>> shared = *make_counted<std::array<int, 16>>(*pools_);
    shared->fill(lap);
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([mine = shared, lap, &wrong] {
        for (int round = 0; round < rounds; ++round) {
          const Counted<const std::array<int, 16>> copy = mine;
          if (copy->back() != lap) ++wrong;
        }
      });
    shared.reset();
    for (std::thread& thread : threads) thread.join();
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(used(), 0U);
}

}  // namespace
}  // namespace hirosco
