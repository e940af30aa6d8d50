// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/turns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <vector>

namespace hirosco::communication {
namespace {

using ::testing::ElementsAre;

/// All turns in their order, which are over then.
std::vector<int> order_of(Turns turns) {
  std::vector<int> order;
  for (; turns.size() > 0; turns.done()) order.push_back(turns.first());
  return order;
}

TEST(Turns, ComeInTheOrderInWhichTheyWereAskedFor) {
  Turns turns;
  for (const std::uint8_t place : std::initializer_list<std::uint8_t>{7, 3, 5}) turns.join(place);
  EXPECT_THAT(order_of(turns), ElementsAre(7, 3, 5));
  turns.pass_over();
  EXPECT_THAT(order_of(turns), ElementsAre(3, 5, 7));
  turns.leave(5);
  EXPECT_THAT(order_of(turns), ElementsAre(3, 7));
  turns.leave(5);
  EXPECT_EQ(turns.size(), 2U) << "who has none leaves none";
}

TEST(Turns, OfAllPlacesGoRoundAndRound) {
  Turns turns;
  for (std::size_t place = 0; place < Turns::most; ++place) turns.join(static_cast<std::uint8_t>(place));
  for (std::size_t i = 0; i < 3 * Turns::most; ++i) {
    ASSERT_EQ(turns.first(), i % Turns::most);
    turns.pass_over();
  }
  turns.leave(0);
  EXPECT_EQ(turns.size(), Turns::most - 1);
  EXPECT_EQ(turns.first(), 1);
}

}  // namespace
}  // namespace hirosco::communication
