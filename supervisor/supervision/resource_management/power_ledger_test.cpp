// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/power_ledger.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hirosco::supervisor {
namespace {

using descriptor::State;

constexpr std::uint16_t robot = 10, handle = 11, light = 12;
constexpr pus::Request of_arm{.id = 0x180AC001, .source = 7}, of_hand{.id = 0x180BC001, .source = 7};
constexpr TimePoint start{}, later = start + 10s;

struct PowerLedgerTest : ::testing::Test {
  PowerLedger ledger{100};
  void uses(std::uint16_t apid, double demand_w) { ledger.observe(apid, State::Operational, demand_w, start); }
};

TEST_F(PowerLedgerTest, OfTwoThatFitAloneTheSecondIsRefusedWithTheNumbers) {
  EXPECT_FALSE(ledger.shortage(robot, 60));
  EXPECT_FALSE(ledger.shortage(handle, 60));
  ledger.reserve(robot, 60, of_arm, later);
  const auto shortage = ledger.shortage(handle, 60);
  ASSERT_TRUE(shortage);
  EXPECT_EQ(shortage->budget, 100'000U);
  EXPECT_EQ(shortage->reserved, 60'000U);
  EXPECT_EQ(shortage->requested, 60'000U);
  EXPECT_FALSE(ledger.shortage(handle, 40)) << "to the last milliwatt";
  EXPECT_TRUE(ledger.shortage(handle, 40.001));
}

TEST_F(PowerLedgerTest, WithoutABudgetEverythingFits) {
  PowerLedger unlimited{std::nullopt};
  unlimited.observe(robot, State::Operational, 1e6, start);
  EXPECT_FALSE(unlimited.shortage(handle, 1e6));
  EXPECT_FALSE(unlimited.overdrawn());
  EXPECT_EQ(unlimited.reserved_mw(), 1'000'000'000U) << "but it is told";
}

TEST_F(PowerLedgerTest, WhoAsksTwiceIsCountedOnce) {
  ledger.reserve(robot, 60, of_arm, later);
  EXPECT_FALSE(ledger.shortage(robot, 60));
  ledger.reserve(robot, 60, of_arm, later);
  EXPECT_EQ(ledger.reserved_mw(), 60'000U);
}

TEST_F(PowerLedgerTest, APermissionHoldsUntilItsTelecommandEnded) {
  ledger.reserve(robot, 60, of_arm, later);
  ledger.observe(robot, State::PreOperational, 60, start);
  EXPECT_EQ(ledger.held_mw(robot), 60'000U) << "on its way";
  ledger.ended(handle, of_hand);
  ledger.ended(robot, {.id = of_arm.id, .source = 8});
  ledger.observe(robot, State::PreOperational, 60, start);
  EXPECT_EQ(ledger.held_mw(robot), 60'000U) << "another telecommand ended";
  ledger.ended(robot, of_arm);
  ledger.observe(robot, State::PreOperational, 60, start);
  EXPECT_EQ(ledger.held_mw(robot), 0U) << "it failed";
}

TEST_F(PowerLedgerTest, NobodyEndsThePermissionOfAnotherButTheSupervisor) {
  for (const auto& [from, left_mw] :
       {std::pair{handle, 60'000U}, std::pair{robot, 0U}, std::pair{pus::supervisor_apid, 0U}}) {
    ledger.reserve(robot, 60, of_arm, later);
    ledger.ended(from, of_arm);
    ledger.observe(robot, State::PreOperational, 60, start);
    EXPECT_EQ(ledger.held_mw(robot), left_mw) << from;
  }
}

TEST_F(PowerLedgerTest, WhatIsUnderWayHasItsTimeFromThenOn) {
  ledger.reserve(robot, 60, of_arm, later);
  ledger.under_way(handle, of_arm, later + 5s);
  ledger.under_way(robot, of_hand, later + 5s);
  ledger.observe(robot, State::PreOperational, 60, later + 1ns);
  EXPECT_EQ(ledger.held_mw(robot), 0U) << "said by another one, or of another one";
  ledger.reserve(robot, 60, of_arm, later);
  ledger.under_way(robot, of_arm, later + 5s);
  ledger.observe(robot, State::PreOperational, 60, later + 5s);
  EXPECT_EQ(ledger.held_mw(robot), 60'000U) << "it is carried out";
  ledger.observe(robot, State::PreOperational, 60, later + 5s + 1ns);
  EXPECT_EQ(ledger.held_mw(robot), 0U);
}

/// Who acts and was permitted another configuration draws what it draws, and has what it may draw next.
TEST_F(PowerLedgerTest, APermittedConfigurationThatDrawsMoreIsHeldUntilItIsThereOrEnded) {
  uses(robot, 20);
  ledger.reserve(robot, 50, of_arm, later);
  uses(robot, 20);
  EXPECT_EQ(ledger.held_mw(robot), 50'000U) << "it has not gone over yet";
  uses(robot, 50);
  uses(robot, 20);
  EXPECT_EQ(ledger.held_mw(robot), 20'000U) << "it was there";
  for (const bool failed : {true, false}) {
    ledger.reserve(robot, 50, of_arm, later);
    if (failed) ledger.ended(robot, of_arm);
    ledger.observe(robot, State::Operational, 20, failed ? start : later + 1ns);
    EXPECT_EQ(ledger.held_mw(robot), 20'000U) << failed;
  }
  ledger.reserve(robot, 20, of_arm, later);
  uses(robot, 20);
  uses(robot, 10);
  EXPECT_EQ(ledger.held_mw(robot), 10'000U) << "one that draws less is held as what it drew until it is there";
}

TEST_F(PowerLedgerTest, APermissionThatNobodyUsedEndsInTime) {
  ledger.reserve(robot, 60, of_arm, later);
  ledger.observe(robot, State::PreOperational, 60, later);
  EXPECT_EQ(ledger.held_mw(robot), 60'000U);
  ledger.observe(robot, State::PreOperational, 60, later + 1ns);
  EXPECT_EQ(ledger.held_mw(robot), 0U);
}

TEST_F(PowerLedgerTest, StatesDecideWhoDraws) {
  for (int value = 0; value <= 9; ++value) {
    const auto state = static_cast<State>(value);
    ledger.observe(robot, State::Operational, 60, start);
    ledger.observe(robot, state, 60, start);
    const bool draws =
        value >= static_cast<int>(State::SafeOperational) && value <= static_cast<int>(State::PostOperational);
    EXPECT_EQ(ledger.held_mw(robot), draws ? 60'000U : 0U) << to_text(state);
  }
}

TEST_F(PowerLedgerTest, TheDeadDrawNothingWhateverWasOnItsWay) {
  ledger.reserve(robot, 60, of_arm, later);
  ledger.observe(robot, std::nullopt, 60, start);
  EXPECT_EQ(ledger.reserved_mw(), 0U);
}

TEST_F(PowerLedgerTest, AConfigurationChangedBehindThePermissionShowsAsOverdrawn) {
  uses(handle, 50);
  ledger.reserve(robot, 50, of_arm, later);
  EXPECT_FALSE(ledger.overdrawn());
  uses(robot, 50.001);
  EXPECT_TRUE(ledger.overdrawn());
}

TEST_F(PowerLedgerTest, ALoweredBudgetTakesNothingAwayButShows) {
  uses(robot, 60);
  uses(handle, 40);
  EXPECT_FALSE(ledger.overdrawn());
  ledger.set_budget(99);
  EXPECT_TRUE(ledger.overdrawn());
  EXPECT_EQ(ledger.reserved_mw(), 100'000U);
  EXPECT_TRUE(ledger.shortage(light, 1));
}

TEST_F(PowerLedgerTest, AnOverdraftIsNewOnceUntilItIsOver) {
  EXPECT_FALSE(ledger.newly_overdrawn());
  uses(robot, 101);
  EXPECT_TRUE(ledger.newly_overdrawn());
  EXPECT_FALSE(ledger.newly_overdrawn());
  uses(robot, 100);
  EXPECT_FALSE(ledger.newly_overdrawn());
  uses(robot, 101);
  EXPECT_TRUE(ledger.newly_overdrawn());
}

TEST_F(PowerLedgerTest, WhatIsMeasuredHoldsForWhoAsksAndNotForWhatIsTaken) {
  uses(robot, 60);
  ledger.set_grantable(50, "dusk");
  EXPECT_EQ(ledger.budget_mw(), 50'000U);
  EXPECT_EQ(ledger.basis(), "dusk");
  EXPECT_TRUE(ledger.shortage(handle, 1));
  EXPECT_FALSE(ledger.shortage(robot, 50)) << "what it has would be replaced";
  EXPECT_TRUE(ledger.shortage(robot, 50.001));
  EXPECT_FALSE(ledger.overdrawn());
  ledger.set_grantable(1000, "noon");
  EXPECT_EQ(ledger.budget_mw(), 100'000U) << "never more than the budget";
}

TEST(PowerLedgerProperties, WhatIsGrantedByAskingFirstNeverExceedsTheBudget) {
  std::mt19937_64 random{1};
  const auto any = [&](std::uint64_t below) { return random() % below; };
  PowerLedger ledger{100};
  for (int i = 0; i < 20'000; ++i) {
    const auto apid = static_cast<std::uint16_t>(10 + any(5));
    const double demand_w = static_cast<double>(1 + any(60'000)) * 1e-3;
    if (any(3) == 0) ledger.observe(apid, State::PreOperational, demand_w, later + 1s);
    else if (!ledger.shortage(apid, demand_w)) ledger.reserve(apid, demand_w, {.id = apid, .source = 7}, later);
    ASSERT_LE(ledger.reserved_mw(), ledger.budget_mw());
  }
}

}  // namespace
}  // namespace hirosco::supervisor
