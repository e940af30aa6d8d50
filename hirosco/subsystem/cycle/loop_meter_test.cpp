// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/loop_meter.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hirosco {
namespace {

struct Loops : ::testing::Test {
  std::vector<descriptor::ServiceLoop> declared{{.name = "SLOW", .period = 20ms, .budget = 900us},
                                                {.name = "FREE", .period = 5ms}};
  LoopMeter meter{declared};
};

TEST_F(Loops, AreToldWithTheirBudgetsInTheOrderOfTheDescriptor) {
  const LoopStatistics told = meter.statistics();
  EXPECT_EQ(told.budget_us[0], 900.0F);
  EXPECT_EQ(told.budget_us[1], 0.0F);
  EXPECT_EQ(told.longest_us[0], 0.0F);
  EXPECT_TRUE(meter.any());
  EXPECT_FALSE(LoopMeter{{}}.any());
}

TEST_F(Loops, TellTheLongestStepAndHowManyTookMoreThanTheBudget) {
  for (const Duration step : {400us, 900us, 950us, 10us, 901us}) meter.account(0, step, 0);
  const LoopStatistics told = meter.statistics();
  EXPECT_EQ(told.longest_us[0], 950.0F);
  EXPECT_EQ(told.exceeded[0], 2U) << "as much as the budget is not more";
  EXPECT_EQ(told.longest_us[1], 0.0F) << "each by itself";
}

TEST_F(Loops, WithoutABudgetExceedNone) {
  meter.account(1, 1h, 0);
  EXPECT_EQ(meter.statistics().exceeded[1], 0U);
  EXPECT_EQ(meter.statistics().longest_us[1], 3.6e9F);
}

/// Another configuration is in force (docs/adr/0207): what was counted stays.
TEST_F(Loops, AreHeldToAnotherBudgetFromWhenItIsPromised) {
  meter.account(0, 950us, 0);
  meter.promise(0, 200us);
  EXPECT_EQ(meter.statistics().budget_us[0], 200.0F);
  meter.account(0, 201us, 0);
  meter.promise(0, 900us);
  meter.account(0, 201us, 0);
  EXPECT_EQ(meter.statistics().exceeded[0], 2U);
  EXPECT_EQ(meter.statistics().longest_us[0], 950.0F);
}

TEST_F(Loops, CountTheStepsForWhichTheyWereTooLate) {
  meter.account(0, 10us, 3);
  meter.account(0, 10us, 0);
  meter.account(0, 10us, 2);
  EXPECT_EQ(meter.statistics().missed[0], 5U);
  EXPECT_EQ(meter.statistics().missed[1], 0U);
}

}  // namespace
}  // namespace hirosco
