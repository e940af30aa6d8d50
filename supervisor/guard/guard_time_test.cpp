// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/guard_time.hpp"

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// What counts as time, by itself: what follows from it is in watching_test.cpp.
namespace hirosco::supervisor {
namespace {

using namespace std::chrono_literals;

/// Of one whose cycle of 1 ms goes on as the test says.
struct TimeOfTheGuard : ::testing::Test {
  LocalFlows flows;
  descriptor::Mission mission = testing::small_mission();
  VitalPage vital;
  GuardRoster guarded{flows, 1000, {}};
  GuardTime time{guarded};
  TimePoint now{10s};

  void SetUp() override {
    GuardedMember member;
    member.described = &mission.subsystems[0];
    member.vital = &vital;
    guarded.add(std::move(member));
    vital.configuration = 2;
    vital.cycling = 1;
    time.step(now);
  }
  void pass(Duration span) {
    now += span;
    time.step(now);
  }
};

TEST_F(TimeOfTheGuard, BeginsWithItsFirstStep) {
  const GuardTime before{guarded};
  EXPECT_EQ(before.watched_at(now + 3s), now + 3s);
  EXPECT_EQ(before.asked_at(now + 3s), now + 3s);
  EXPECT_EQ(time.watched(), now);
  EXPECT_EQ(time.asked(), now);
}

TEST_F(TimeOfTheGuard, CountsInFullUpToTheMostThatMayPassBetweenTwoSteps) {
  for (const Duration span : {guard_period, GuardTime::most_unwatched}) pass(span);
  EXPECT_EQ(time.watched(), now);
  EXPECT_EQ(time.asked(), now);
  EXPECT_EQ(time.watched_at(now + guard_period), now + guard_period);
  EXPECT_EQ(time.asked_at(now + guard_period), now + guard_period);
}

TEST_F(TimeOfTheGuard, OfALongerPauseOfAllCountsLittle) {
  const TimePoint begun = now;
  pass(2s);
  EXPECT_EQ(time.watched(), begun + GuardTime::most_unwatched);
  EXPECT_EQ(time.asked(), begun + GuardTime::most_unwatched);
  pass(guard_period);
  EXPECT_EQ(time.watched(), begun + GuardTime::most_unwatched + guard_period);
}

TEST_F(TimeOfTheGuard, WhileACycleWentOnAPauseWasWatchedAndNobodyCouldBeAskedInIt) {
  const TimePoint begun = now;
  vital.cycles += 501;  // half of those that were due, and one
  pass(1s);
  EXPECT_EQ(time.watched(), now);
  EXPECT_EQ(time.asked(), begun + GuardTime::most_unwatched);
}

TEST_F(TimeOfTheGuard, WhoMadeFewerCyclesOrIsNotCyclingDidNotGoOn) {
  const TimePoint begun = now;
  vital.cycles += 500;
  pass(1s);
  EXPECT_EQ(time.watched(), begun + GuardTime::most_unwatched);
  vital.cycles += 10'000;
  vital.cycling = 0;
  pass(1s);
  EXPECT_EQ(time.watched(), begun + 2 * GuardTime::most_unwatched);
}

}  // namespace
}  // namespace hirosco::supervisor
