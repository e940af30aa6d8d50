// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper_watch.hpp"

#include <gtest/gtest.h>
#include <signal.h>

/// What a supervisor makes of its keeper's page and of the end of its pipe (docs/adr/0217).
namespace hirosco::supervisor {
namespace {

using namespace std::chrono_literals;
using Keeper = KeeperWatch::Keeper;

struct KeeperWatchTest : ::testing::Test {
  KeeperPage page;
  KeeperWatch watch{page, Keeper::Here};
  TimePoint now{10s};

  KeeperWatch::Finding look_after(Duration passed) {
    now += passed;
    return watch.look(now);
  }
  /// Every 100 ms for so long; how often it was found to have begun to stand still.
  int still_for(Duration time) {
    int found = 0;
    for (const TimePoint end = now + time; now < end;) found += look_after(100ms).still ? 1 : 0;
    return found;
  }
};

TEST_F(KeeperWatchTest, OneThatMovesIsNothingToTell) {
  for (int i = 0; i < 100; ++i) {
    page.keeper.fetch_add(1);
    const auto found = look_after(100ms);
    EXPECT_FALSE(found.still || found.lost || found.stop || found.end != 0) << i;
  }
  EXPECT_TRUE(watch.here());
  EXPECT_FALSE(watch.lost());
}

TEST_F(KeeperWatchTest, OneThatStandsStillIsToldOnceEachTimeAndIsStillThere) {
  page.keeper = 1;
  EXPECT_EQ(still_for(2 * keeper_patience), 1);
  page.keeper = 2;
  EXPECT_EQ(still_for(2 * keeper_patience), 1);
  EXPECT_TRUE(watch.here());
  EXPECT_FALSE(watch.lost());
}

TEST_F(KeeperWatchTest, OneThatIsGoneIsToldOnceAndNotAsOneThatStandsStill) {
  page.keeper = 1;
  static_cast<void>(look_after(0s));
  watch.gone();
  EXPECT_FALSE(watch.here());
  EXPECT_TRUE(watch.lost());
  EXPECT_TRUE(look_after(1ms).lost);
  EXPECT_EQ(still_for(2 * keeper_patience), 0);
  EXPECT_FALSE(look_after(1ms).lost);
}

TEST_F(KeeperWatchTest, OneThatStoodStillAndIsGoneIsToldAsGone) {
  page.keeper = 1;
  EXPECT_EQ(still_for(2 * keeper_patience), 1);
  watch.gone();
  EXPECT_TRUE(look_after(1ms).lost);
}

TEST_F(KeeperWatchTest, WithOneThatIsGoneTheFlightGoesOn) {
  watch.gone();
  for (int i = 0; i < 100; ++i) {
    const auto found = look_after(1s);
    EXPECT_FALSE(found.stop || found.end != 0) << i;
  }
}

TEST_F(KeeperWatchTest, AStopThatItHadCountedAndNobodyHasNotedIsCarriedOutForIt) {
  page.stops_asked = 3;
  page.stops_taken = 2;
  EXPECT_FALSE(look_after(1ms).stop) << "it is the keeper's to hand on while it is there";
  watch.gone();
  EXPECT_TRUE(look_after(1ms).stop);
  EXPECT_FALSE(look_after(1ms).stop) << "once";
}

TEST_F(KeeperWatchTest, AnEndThatItWasAskedForAndMayNotHaveHandedOnIsCarriedOutForIt) {
  page.end_asked = SIGTERM;
  EXPECT_EQ(look_after(1ms).end, 0U);
  watch.gone();
  EXPECT_EQ(look_after(1ms).end, static_cast<std::uint32_t>(SIGTERM));
  EXPECT_EQ(look_after(1ms).end, 0U) << "once";
}

TEST_F(KeeperWatchTest, AFlightOfSoLongEndsInItsTimeWithoutItsKeeper) {
  page.ends_at = (now + 60s).time_since_epoch().count();
  watch.gone();
  EXPECT_EQ(look_after(59s).end, 0U);
  EXPECT_EQ(look_after(1s).end, KeeperPage::end_of_time);
  EXPECT_EQ(look_after(1s).end, 0U) << "once";
}

TEST_F(KeeperWatchTest, AFlightOfSoLongWhoseKeeperIsThereIsEndedByThat) {
  page.ends_at = (now + 60s).time_since_epoch().count();
  page.keeper = 1;
  EXPECT_EQ(look_after(100s).end, 0U);
}

TEST_F(KeeperWatchTest, WhereThereNeverWasOneNothingIsTold) {
  KeeperWatch alone{page, Keeper::Nobody};
  page.stops_asked = 1;
  page.end_asked = SIGTERM;
  page.ends_at = 1;
  EXPECT_FALSE(alone.here());
  EXPECT_FALSE(alone.lost()) << "nothing of what a keeper did is this one's to do";
  for (int i = 0; i < 100; ++i) {
    const auto found = alone.look(now += 100ms);
    EXPECT_FALSE(found.still || found.lost || found.stop || found.end != 0) << i;
  }
}

}  // namespace
}  // namespace hirosco::supervisor
