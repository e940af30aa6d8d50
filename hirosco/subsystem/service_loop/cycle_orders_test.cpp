// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/cycle_orders.hpp"

#include <gtest/gtest.h>

/// When a cycle rests: only then is what it used given back.
namespace hirosco {
namespace {

struct Ordered : ::testing::Test {
  VitalPage vital{};
  CycleOrders orders{vital};
  [[nodiscard]] bool watched() const { return vital.cycling.load() != 0; }
};

TEST_F(Ordered, ACycleThatNobodyWantedRests) {
  EXPECT_TRUE(orders.rests());
  EXPECT_FALSE(orders.order().wanted);
}

TEST_F(Ordered, OneThatWasCalledOffRestsOnlyWhenItsThreadHasSaidSo) {
  orders.want();
  EXPECT_FALSE(orders.rests());
  EXPECT_TRUE(watched());
  orders.rest();
  EXPECT_FALSE(orders.rests()) << "it may be within a cycle";
  EXPECT_TRUE(watched()) << "one that spins after the order is still to be found";
  orders.parked(orders.order().ticket);
  EXPECT_TRUE(orders.rests());
  EXPECT_FALSE(watched());
}

TEST_F(Ordered, ALateAnswerToAnEarlierOrderIsNoneToTheNewest) {
  orders.want();
  orders.rest();
  const auto earlier = orders.order().ticket;
  orders.parked(earlier);
  orders.want();
  orders.rest();
  orders.parked(earlier);
  EXPECT_FALSE(orders.rests());
  orders.parked(orders.order().ticket);
  EXPECT_TRUE(orders.rests());
}

TEST_F(Ordered, AnAnswerThatIsRepeatedDoesNotHideTheCycleThatHasBegunSince) {
  orders.want();
  orders.rest();
  const auto ticket = orders.order().ticket;
  orders.parked(ticket);
  orders.want();
  orders.parked(ticket);
  EXPECT_TRUE(watched());
  EXPECT_TRUE(orders.order().wanted);
}

TEST_F(Ordered, EachConfigurationIsAGenerationAndAnOrderToRestIsCountedOnce) {
  orders.want();
  const auto first = orders.order();
  orders.rest();
  const auto ordered = orders.order().ticket;
  orders.rest();
  EXPECT_EQ(orders.order().ticket, ordered);
  EXPECT_NE(ordered, first.ticket);
  EXPECT_EQ(orders.order().generation, 0u) << "who is to rest has nothing to begin";
  orders.want();
  EXPECT_GT(orders.order().generation, first.generation);
}

}  // namespace
}  // namespace hirosco
