// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/restart_schedule.hpp"

#include <gtest/gtest.h>

namespace hirosco::supervisor {
namespace {

using namespace std::chrono_literals;
using enum Restarts::AtLimit;

constexpr std::uint16_t crashing = 10;
constexpr Restarts::Rule rule{.limit = 3, .within = 60s, .pause = 100ms};

TEST(Restarts, ThePauseDoublesAndAtTheLimitItStaysDown) {
  Restarts restarts;
  TimePoint now{};
  for (const Duration pause : {Duration{100ms}, Duration{200ms}, Duration{400ms}}) {
    ASSERT_TRUE(restarts.plan(crashing, rule, now));
    EXPECT_EQ(restarts.take_due(now + pause - 1ns), std::nullopt);
    EXPECT_EQ(restarts.take_due(now + pause), crashing);
    EXPECT_EQ(restarts.take_due(now + pause), std::nullopt);
  }
  EXPECT_FALSE(restarts.plan(crashing, rule, now));
  EXPECT_TRUE(restarts.plan(crashing, rule, now + rule.within));
}

TEST(Restarts, WhatMayNotStayDownIsStartedBeyondTheLimitWithABoundedPause) {
  Restarts restarts;
  const TimePoint now{};
  for (int death = 0; death < 50; ++death) ASSERT_TRUE(restarts.plan(crashing, rule, now, GoesOn)) << death;
  EXPECT_EQ(restarts.take_due(now + Restarts::longest_pause - 1ns), std::nullopt);
  EXPECT_EQ(restarts.take_due(now + Restarts::longest_pause), crashing);
}

TEST(Restarts, NothingIsStartedAfterTheyWereCancelled) {
  Restarts restarts;
  ASSERT_TRUE(restarts.plan(crashing, rule, TimePoint{}));
  restarts.cancel();
  EXPECT_EQ(restarts.take_due(TimePoint{} + 60s), std::nullopt);
}

}  // namespace
}  // namespace hirosco::supervisor
