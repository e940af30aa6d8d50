// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/budget_watch.hpp"

#include <gtest/gtest.h>

namespace hirosco {
namespace {

struct ABudget : ::testing::Test {
  ABudget() {
    configuration.budget = 100us;
    configuration.overruns = {.realtime = 3, .reduced = 5};
    watch.begin(configuration, true);
  }
  bool take(Duration cycle) { return watch.account(used += cycle); }

  descriptor::Configuration configuration;
  BudgetWatch watch;
  Duration used{7s};
};

TEST_F(ABudget, SaysNothingOfTheTimeBeforeTheFirstCycle) {
  EXPECT_FALSE(watch.account(used));
  EXPECT_EQ(watch.told().longest_us, 0.0F);
  EXPECT_EQ(watch.told().exceeded, 0U);
}

TEST_F(ABudget, TellsTheLongestCycleAndHowManyTookMore) {
  static_cast<void>(watch.account(used));
  for (const Duration cycle : {40us, 100us, 130us, 60us, 120us}) EXPECT_FALSE(take(cycle));
  EXPECT_EQ(watch.told().budget_us, 100.0F);
  EXPECT_EQ(watch.told().longest_us, 130.0F);
  EXPECT_EQ(watch.told().exceeded, 2U) << "as much as the budget is not more";
}

TEST_F(ABudget, IsToldOnceForEachRowThatIsLongEnough) {
  static_cast<void>(watch.account(used));
  for (int row = 0; row < 2; ++row) {
    EXPECT_FALSE(take(101us));
    EXPECT_FALSE(take(101us));
    EXPECT_TRUE(take(101us));
    EXPECT_FALSE(take(101us));
    EXPECT_EQ(watch.in_a_row(), 4U);
    EXPECT_FALSE(take(99us));
  }
}

TEST_F(ABudget, HasTheLongerLimitWithoutRealTimeScheduling) {
  watch.begin(configuration, false);
  static_cast<void>(watch.account(used));
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(take(101us));
  EXPECT_TRUE(take(101us));
}

TEST_F(ABudget, ThatIsNotDeclaredIsNotExceededAndTheLongestCycleIsToldAllTheSame) {
  configuration.budget = {};
  watch.begin(configuration, true);
  static_cast<void>(watch.account(used));
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(take(1ms));
  EXPECT_EQ(watch.told().exceeded, 0U);
  EXPECT_EQ(watch.told().longest_us, 1000.0F);
}

TEST_F(ABudget, BeginsAnewWithEachConfiguration) {
  static_cast<void>(watch.account(used));
  static_cast<void>(take(300us));
  watch.begin(configuration, true);
  EXPECT_FALSE(take(5s)) << "what passed in between is no cycle";
  EXPECT_EQ(watch.told().longest_us, 0.0F);
  EXPECT_EQ(watch.told().exceeded, 0U);
}

TEST_F(ABudget, CountsWhatIsSpunAwayForItself) {
  watch.begin(configuration, true, 80us);
  static_cast<void>(watch.account(used));
  const auto spin_and_take = [&](Duration spun, Duration cycle) {
    watch.account_spin(spun);
    return take(spun + cycle);
  };
  EXPECT_FALSE(spin_and_take(75us, 100us));
  EXPECT_FALSE(spin_and_take(60us, 40us));
  EXPECT_EQ(watch.told().longest_us, 100.0F);
  EXPECT_EQ(watch.told().exceeded, 0U);
  EXPECT_EQ(watch.told_spin().spin_us, 80.0F);
  EXPECT_EQ(watch.told_spin().longest_us, 75.0F);
  EXPECT_EQ(watch.told_spin().exceeded, 0U);
  EXPECT_FALSE(take(130us)) << "which did not spin";
  EXPECT_EQ(watch.told().exceeded, 1U);
}

TEST_F(ABudget, IsToldOfARowThatSpinsTooLong) {
  watch.begin(configuration, true, 80us);
  static_cast<void>(watch.account(used));
  for (const bool told : {false, false, true, false}) {
    watch.account_spin(81us);
    EXPECT_EQ(take(81us + 10us), told);
  }
  EXPECT_EQ(watch.told_spin().exceeded, 4U);
  EXPECT_EQ(watch.told().exceeded, 0U) << "its work is within its budget";
  watch.account_spin(80us);
  EXPECT_FALSE(take(80us + 10us));
  EXPECT_EQ(watch.in_a_row(), 0U);
}

}  // namespace
}  // namespace hirosco
