// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/permit_watch.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

/// The supervisor's permission as the cycle asks for it. What comes of it in a cycle stands in cycle_test.cpp, its silence in
/// supervisor_silence_test.cpp.
namespace hirosco {
namespace {

struct APermission : ::testing::Test {
  PermitPage page{};
  ControlState control;
  std::vector<descriptor::Event> events;
  LoopRings rings;
  ReportWriter reports{events, rings};
  std::unique_ptr<VitalPage> vital = std::make_unique<VitalPage>();
  PermitWatch watch{page, {control, reports, *vital}};
};

TEST_F(APermission, HoldsFromItsReleaseOn) {
  EXPECT_FALSE(watch.permits()) << "nobody has given it yet";
  page.release();
  EXPECT_TRUE(watch.permits());
}

TEST_F(APermission, EndsWithTheStopFlagThoughItsWordStillHolds) {
  page.release();
  page.stop.store(1);
  EXPECT_FALSE(watch.permits());
}

TEST_F(APermission, EndsWithItsWordThoughNoStopIsSet) {
  page.release();
  page.go.store(0);
  EXPECT_FALSE(watch.permits());
}

TEST_F(APermission, ThatEndsWithoutAStopInhibitsInOperationalAlone) {
  for (const State state :
       {State::PreOperational, State::SafeOperational, State::Operational, State::ErrorOperational}) {
    control.begin();
    control.enter(state);
    page.release();
    watch.enter_operational();
    watch.check();
    EXPECT_EQ(control.inhibited(), 0U) << to_text(state);
    page.epoch.fetch_add(1);
    watch.check();
    EXPECT_EQ(control.inhibited(), state == State::Operational ? inhibited_by_stop : 0U) << to_text(state);
  }
}

TEST_F(APermission, OfAnEarlierEpochIsNone) {
  page.release();
  page.epoch.fetch_add(1);
  EXPECT_FALSE(watch.permits());
  page.release();
  EXPECT_TRUE(watch.permits());
}

}  // namespace
}  // namespace hirosco
