// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/telepresence_relay/delay_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace hirosco::telepresence_relay {
namespace {

using testing::ElementsAre;

TEST(DelayLine, GivesEachSetAfterItsDelayAndHoldsTheLastWhereOneIsLost) {
  DelayLine<int> line;
  std::vector<int> out;
  for (int k = 1; k <= 8; ++k) out.push_back(line.pass(k, k != 4, 2));
  EXPECT_THAT(out, ElementsAre(0, 0, 1, 2, 3, 3, 5, 6));
  EXPECT_EQ(line.age_cycles(), 0U);
  for (int k = 0; k < 5; ++k) line.pass(9, false, 2);
  EXPECT_EQ(line.age_cycles(), 3U);
}

TEST(DelayLine, ReachesItsLongestDelay) {
  DelayLine<int> line;
  int out = 0;
  for (int k = 1; k <= 1000; ++k) out = line.pass(k, true, line.longest_cycles);
  EXPECT_EQ(out, 1000 - 127);
}

TEST(Loss, StrikesByItsShare) {
  Loss loss;
  int lost = 0;
  for (int k = 0; k < 100'000; ++k) lost += loss.strikes(0.1) ? 1 : 0;
  EXPECT_NEAR(lost, 10'000, 500);
  EXPECT_FALSE(loss.strikes(0));
  EXPECT_TRUE(loss.strikes(1));
}

}  // namespace
}  // namespace hirosco::telepresence_relay
