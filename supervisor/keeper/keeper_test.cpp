// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "supervisor/keeper/keeper.hpp"

/// Keeper and supervisor look at each other's counter on a page that both may write (hazards SF18 and SF19).
namespace hirosco::supervisor {
namespace {

using namespace std::chrono_literals;

TEST(Progress, BeforeTheFirstStepNobodyStandsStill) {
  Progress progress;
  for (TimePoint now{1s}; now < TimePoint{60s}; now += 100ms) EXPECT_FALSE(progress.stands_still(0, now));
}

TEST(Progress, StandsStillOnceItsPatienceIsOverAndNoLongerWhenItMoves) {
  Progress progress;
  EXPECT_FALSE(progress.stands_still(5, TimePoint{10s}));
  EXPECT_FALSE(progress.stands_still(5, TimePoint{10s} + keeper_patience));
  EXPECT_TRUE(progress.stands_still(5, TimePoint{10s} + keeper_patience + 1ms));
  EXPECT_FALSE(progress.stands_still(6, TimePoint{14s}));
}

TEST(Progress, NoDamageOfTheCounterHidesThatItStandsStillForLongerThanOnePatience) {
  constexpr std::uint64_t count = 0x1234;
  std::vector<std::uint64_t> damages{0, ~std::uint64_t{0}, ~count, 1, count - 1};
  for (unsigned bit = 0; bit < 64; ++bit) damages.push_back(count ^ std::uint64_t{1} << bit);
  for (const std::uint64_t damaged : damages) {
    Progress progress;
    EXPECT_FALSE(progress.stands_still(count, TimePoint{10s}));
    EXPECT_FALSE(progress.stands_still(damaged, TimePoint{11s}));
    EXPECT_TRUE(progress.stands_still(damaged, TimePoint{11s} + keeper_patience + 1ms)) << damaged;
  }
}

}  // namespace
}  // namespace hirosco::supervisor
