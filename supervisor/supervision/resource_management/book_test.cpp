// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/book.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace hirosco::supervisor {
namespace {

constexpr std::uint16_t crane = 10, stick = 11;

TEST(Book, OfTwoThatFitAloneTheSecondIsRefusedWithTheNumbers) {
  Book book;
  book.set_budget(100);
  EXPECT_FALSE(book.shortage(crane, 60));
  book.hold(crane, 60);
  const auto shortage = book.shortage(stick, 60);
  ASSERT_TRUE(shortage);
  EXPECT_EQ(shortage->budget, 100U);
  EXPECT_EQ(shortage->reserved, 60U);
  EXPECT_EQ(shortage->requested, 60U);
  EXPECT_FALSE(book.shortage(stick, 40));
  EXPECT_FALSE(book.shortage(crane, 100)) << "what it has would be replaced";
  book.hold(crane, 0);
  EXPECT_FALSE(book.shortage(stick, 60)) << "it was given back";
}

TEST(Book, WithoutABudgetEverythingFitsAndIsCounted) {
  Book book;
  book.hold(crane, std::numeric_limits<std::uint32_t>::max());
  EXPECT_FALSE(book.shortage(stick, 7));
  book.hold(stick, 7);
  EXPECT_EQ(book.reserved(), std::numeric_limits<std::uint32_t>::max()) << "no sum wraps to little";
  EXPECT_FALSE(book.overdrawn());
  book.set_budget(8);
  EXPECT_TRUE(book.overdrawn());
}

TEST(Book, WhatIsGrantedByAskingFirstNeverExceedsTheBudget) {
  std::mt19937_64 random{2};
  Book book;
  book.set_budget(1'000);
  for (int i = 0; i < 20'000; ++i) {
    const auto holder = static_cast<std::uint16_t>(10 + random() % 6);
    const auto amount = static_cast<std::uint32_t>(random() % 600);
    if (!book.shortage(holder, amount)) book.hold(holder, amount);
    ASSERT_LE(book.reserved(), book.budget());
  }
}

}  // namespace
}  // namespace hirosco::supervisor
