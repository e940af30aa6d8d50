// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/allocation_guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/refused_allocations.hpp"

namespace hirosco {
namespace {

class AllocationGuard : public testing::Test {
 protected:
  void SetUp() override {
    if (!RealtimeScope::hook_present()) GTEST_SKIP() << "a sanitizer owns the heap functions in this build";
  }
};

/// Keeps the compiler from removing an allocation nobody looks at.
void keep(const void* place) { asm volatile("" : : "g"(place) : "memory"); }

TEST_F(AllocationGuard, CountsAPlantedOperatorNew) {
  const RealtimeScope scope;
  keep(std::make_unique<std::array<char, 100>>().get());
  EXPECT_EQ(scope.count(), (AllocationCount{.allocations = 1, .frees = 1, .octets = 100}));
}

TEST_F(AllocationGuard, CountsEveryHeapFunctionOfTheCLibrary) {
  const RealtimeScope scope;
  void* place = std::malloc(10);
  keep(place);
  place = std::realloc(place, 2000);  // NOLINT(bugprone-suspicious-realloc-usage)
  keep(place);
  std::free(place);
  place = std::calloc(3, 5);
  keep(place);
  std::free(place);
  place = std::aligned_alloc(64, 128);
  keep(place);
  std::free(place);
  void* aligned = nullptr;
  ASSERT_EQ(::posix_memalign(&aligned, 256, 32), 0);
  keep(aligned);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(aligned) % 256, 0U);
  std::free(aligned);
  EXPECT_EQ(scope.count(), (AllocationCount{.allocations = 5, .frees = 4, .octets = 10 + 2000 + 15 + 128 + 32}));
}

TEST_F(AllocationGuard, CountsNothingForCodeThatDoesNotAllocate) {
  std::vector<int> numbers(1000);
  const RealtimeScope scope;
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int>(i * 7919 % 1000);
  std::ranges::sort(numbers);
  keep(numbers.data());
  EXPECT_EQ(scope.count(), AllocationCount{});
}

TEST_F(AllocationGuard, CountsNothingOutsideAScopeAndInAPermittedPlace) {
  keep(std::make_unique<int>(1).get());
  const RealtimeScope scope;
  {
    const HeapPermitted permitted;
    keep(std::make_unique<int>(2).get());
  }
  EXPECT_EQ(scope.count(), AllocationCount{});
  keep(std::make_unique<int>(3).get());
  EXPECT_EQ(scope.count().allocations, 1U);
}

TEST_F(AllocationGuard, AScopeInsideAScopeCountsItsOwnPart) {
  const RealtimeScope outer;
  keep(std::make_unique<int>(1).get());
  {
    const RealtimeScope inner;
    keep(std::make_unique<int>(2).get());
    EXPECT_EQ(inner.count().allocations, 1U);
  }
  EXPECT_EQ(outer.count().allocations, 2U);
}

TEST_F(AllocationGuard, AnotherThreadIsNotInTheScope) {
  bool done = false;
  auto thread = [&] { return Thread::start("other", [&] { keep(std::make_unique<int>(1).get()), done = true; }); };
  AllocationCount counted;
  {
    auto started = thread();
    ASSERT_TRUE(started);
    const RealtimeScope scope;
    started->join();
    counted = scope.count();
  }
  EXPECT_TRUE(done);
  EXPECT_EQ(counted.allocations, 0U);
}

TEST_F(AllocationGuard, RefusesTheAllocationThatItIsToldToAndNoOther) {
  RefusedAllocations refusals;
  const auto finds_memory = [] {
    void* const place = std::malloc(10);
    keep(place);
    std::free(place);
    return place != nullptr;
  };
  refusals.refuse(2);
  EXPECT_TRUE(finds_memory()) << "it does not count yet";
  refusals.set_counting(true);
  EXPECT_TRUE(finds_memory());
  EXPECT_FALSE(refusals.refused());
  EXPECT_FALSE(finds_memory());
  EXPECT_TRUE(refusals.refused());
  EXPECT_TRUE(finds_memory());
  refusals.refuse(1);
  EXPECT_THROW(keep(std::make_unique<int>().get()), std::bad_alloc);
}

TEST_F(AllocationGuard, GivesTheHandlerOfNewTheRefusalAndMemoryBehindThat) {
  static int handled = 0;
  RefusedAllocations refusals;
  const auto before = std::set_new_handler([] { ++handled; });
  refusals.refuse(1);
  refusals.set_counting(true);
  keep(std::make_unique<int>().get());
  std::set_new_handler(before);
  EXPECT_EQ(handled, 1);
}

TEST_F(AllocationGuard, AbortsOnAPlantedAllocationInTestMode) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        const RealtimeScope scope{HeapUse::Abort};
        keep(std::make_unique<int>(1).get());
      },
      "");
}

}  // namespace
}  // namespace hirosco
