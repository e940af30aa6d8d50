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

/// Looks every 100 ms from then to the end.
bool looks(Progress& progress, std::uint64_t count, TimePoint from, TimePoint end) {
  bool still = false;
  for (TimePoint now = from; now <= end; now += 100ms) still = progress.stands_still(count, now);
  return still;
}

TEST(Progress, StandsStillOnceItsPatienceIsOverAndNoLongerWhenItMoves) {
  Progress progress;
  EXPECT_FALSE(progress.stands_still(5, TimePoint{10s}));
  EXPECT_FALSE(looks(progress, 5, TimePoint{10s}, TimePoint{10s} + keeper_patience));
  EXPECT_TRUE(progress.stands_still(5, TimePoint{10s} + keeper_patience + 1ms));
  EXPECT_FALSE(progress.stands_still(6, TimePoint{14s}));
}

TEST(Progress, APauseOfTheWholeComputerIsNoStandstill) {
  Progress progress;
  EXPECT_FALSE(looks(progress, 5, TimePoint{10s}, TimePoint{12s}));
  EXPECT_FALSE(progress.stands_still(5, TimePoint{100s}));
  EXPECT_FALSE(looks(progress, 6, TimePoint{100s}, TimePoint{102s}));
  EXPECT_TRUE(looks(progress, 6, TimePoint{102s}, TimePoint{104s})) << "whoever stands is seen afterwards";
}

TEST(Progress, NoDamageOfTheCounterHidesThatItStandsStillForLongerThanOnePatience) {
  constexpr std::uint64_t count = 0x1234;
  std::vector<std::uint64_t> damages{0, ~std::uint64_t{0}, ~count, 1, count - 1};
  for (unsigned bit = 0; bit < 64; ++bit) damages.push_back(count ^ std::uint64_t{1} << bit);
  for (const std::uint64_t damaged : damages) {
    Progress progress;
    EXPECT_FALSE(progress.stands_still(count, TimePoint{10s}));
    EXPECT_FALSE(progress.stands_still(damaged, TimePoint{11s}));
    EXPECT_TRUE(looks(progress, damaged, TimePoint{11s}, TimePoint{11s} + keeper_patience + 100ms)) << damaged;
  }
}

}  // namespace
}  // namespace hirosco::supervisor
