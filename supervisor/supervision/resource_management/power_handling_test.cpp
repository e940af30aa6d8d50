// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/power_handling.hpp"

#include <algorithm>

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

TEST_F(PowerHandlingTest, WhoMeasuresTheBudgetIsNotShedForIt) {
  start_all(SafeOperational);
  set(arm, PreOperational);  // draws nothing
  auto& measured = craft.mission.power_measured;
  measured = descriptor::MeasuredPower{.name = "HAND.BUDGET", .age = {}, .apid = hand, .at = {}};
  lower_to(30);
  EXPECT_TRUE(parts.power.ledger().overdrawn());
  EXPECT_FALSE(craft.member(hand)->recovery.going_down());
  measured->apid = camera;
  parts.power.watch(clock.now());
  EXPECT_TRUE(craft.member(hand)->recovery.going_down()) << "who does not is";
}

/// What it finds where it goes on for another one, whose ground has left it nothing.
TEST_F(PowerHandlingTest, ForASupervisorThatDrawsMoreThanThereIsAllOthersAreShedOnceAndItStaysUp) {
  parts.power.ledger().set_budget(1);
  start_all(SafeOperational);
  set(arm, SafeOperational, 2);
  start_supervisor();
  for (int step = 0; step < 5; ++step) {
    parts.power.watch(clock.now());
    own_step();
  }
  EXPECT_EQ(parts.power.ledger().held_mw(supervisor_apid), 12'000U);
  EXPECT_TRUE(craft.member(arm)->recovery.going_down());
  EXPECT_TRUE(craft.member(hand)->recovery.going_down());
  EXPECT_FALSE(craft.member(camera)->recovery.going_down()) << "the ground link";
  const auto tells = [](const std::string& line) { return line.find("LOAD_SHED BUDGET") != std::string::npos; };
  EXPECT_EQ(std::ranges::count_if(story, tells), 1);
  EXPECT_EQ(parts.own.state(), Operational);
  EXPECT_EQ(call_own("SET_POWER_BUDGET", 500), "done") << "which is what it is up for";
  EXPECT_FALSE(parts.power.ledger().overdrawn());
}

TEST_F(PowerHandlingTest, NothingIsShedWhileTheFlightEnds) {
  start_all(SafeOperational);
  craft.shutting_down = true;
  lower_to(1);
  EXPECT_FALSE(craft.member(hand)->recovery.going_down());
}

}  // namespace
}  // namespace hirosco::supervisor
