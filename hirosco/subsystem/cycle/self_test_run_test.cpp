// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/self_test_run.hpp"

#include <gtest/gtest.h>

#include <vector>

/// One run by itself; with the subsystem around it: service_loop/self_tests_test.cpp.
namespace hirosco {
namespace {

struct RunOfASelfTest : ::testing::Test {
  std::vector<descriptor::Event> events;
  LoopRings rings;
  ReportWriter reports{events, rings};
  SelfTestRun run{reports};

  void SetUp() override { run.begin({}, 1s); }
};

TEST_F(RunOfASelfTest, GoesOnWhereTheSubsystemComesToSafeOperationalAndEndsWithEveryOtherState) {
  run.leave(State::SafeOperational);
  EXPECT_TRUE(run.running());
  EXPECT_FALSE(rings.reports_wait());
  for (const State state : {State::Operational, State::ErrorOperational, State::PreOperational}) {
    run.begin({}, 1s);
    run.leave(state);
    EXPECT_FALSE(run.running()) << to_text(state);
    EXPECT_FALSE(run.passed()) << to_text(state);
    EXPECT_TRUE(rings.reports_wait()) << to_text(state);
  }
}

TEST_F(RunOfASelfTest, ThatPassedHoldsInOperationalAndIsVoidWithErrorOperational) {
  run.take(Step::Done, TimePoint{});
  for (const State state : {State::Operational, State::SafeOperational}) {
    run.leave(state);
    EXPECT_TRUE(run.passed()) << to_text(state);
  }
  run.leave(State::ErrorOperational);
  EXPECT_FALSE(run.passed());
}

}  // namespace
}  // namespace hirosco
