// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/power_handling.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using enum descriptor::State;

struct PowerHandlingTest : PartsTest {
  void lower_to(double budget_w) {
    parts.power.ledger().set_budget(budget_w);
    parts.power.watch(clock.now());
  }
};

TEST_F(PowerHandlingTest, EverybodyDrawsWhatItsConfigurationSaysOnceItIsPastPreOperational) {
  start_all(SafeOperational);
  set(arm, SafeOperational, 2);
  set(hand, PreOperational);
  parts.power.observe();
  EXPECT_EQ(parts.power.ledger().held_mw(arm), 60'000U);
  EXPECT_EQ(parts.power.ledger().held_mw(hand), 0U);
  EXPECT_EQ(parts.power.ledger().held_mw(camera), 20'000U);
}

TEST_F(PowerHandlingTest, OfABudgetThatNoLongerHoldsTheLastOfTheMissionIsShedFirstTheGroundLinkNever) {
  start_all(SafeOperational);
  set(arm, SafeOperational, 2);
  lower_to(90);
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_TRUE(craft.member(hand)->recovery.going_down());
  EXPECT_FALSE(craft.member(arm)->recovery.going_down()) << "what is left fits";
  lower_to(10);
  EXPECT_TRUE(craft.member(arm)->recovery.going_down());
  EXPECT_FALSE(craft.member(camera)->recovery.going_down());
}

TEST_F(PowerHandlingTest, NothingIsShedWhileTheFlightEnds) {
  start_all(SafeOperational);
  craft.shutting_down = true;
  lower_to(1);
  EXPECT_FALSE(craft.member(hand)->recovery.going_down());
}

}  // namespace
}  // namespace hirosco::supervisor
