// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/memory_reserve.hpp"

#include <gtest/gtest.h>

#include <new>

namespace hirosco {
namespace {

constexpr std::size_t octets_in_reserve = std::size_t{1} << 20;

TEST(MemoryReserve, IsGivenBackOnceWhenThereIsNoMoreMemoryAndWhoLooksIsTold) {
  const MemoryReserve reserve{octets_in_reserve};
  EXPECT_FALSE(reserve.used());
  const auto asked_for_memory = std::get_new_handler();
  ASSERT_NE(asked_for_memory, nullptr);
  asked_for_memory();
  EXPECT_TRUE(reserve.used());
  EXPECT_THROW(asked_for_memory(), std::bad_alloc);
}

TEST(MemoryReserve, LeavesNothingBehindWhetherItWasUsedOrNot) {
  const auto before = std::get_new_handler();
  { const MemoryReserve unused{octets_in_reserve}; }
  EXPECT_EQ(std::get_new_handler(), before);
  {
    const MemoryReserve used{octets_in_reserve};
    std::get_new_handler()();
  }
  EXPECT_EQ(std::get_new_handler(), before);
  const MemoryReserve next{octets_in_reserve};
  EXPECT_FALSE(next.used());
}

}  // namespace
}  // namespace hirosco
