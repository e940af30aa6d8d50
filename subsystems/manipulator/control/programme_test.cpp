// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/programme.hpp"

#include <gtest/gtest.h>

namespace hirosco::manipulator {
namespace {

using Pace = Legs::Pace;

TEST(Legs, GoOneAfterTheOtherEachToItsEnd) {
  Legs legs;
  legs.add({Pace::MinimumJerk, 1, {}});
  legs.add({Pace::Even, 2, {}});
  EXPECT_EQ(legs.size(), 2U);
  EXPECT_EQ(legs.advance(0.5).share, 0.5);
  const auto end = legs.advance(0.5);
  EXPECT_EQ(end.leg, 0U);
  EXPECT_EQ(end.share, 1);
  EXPECT_EQ(legs.leg(), 1U);
  const auto half = legs.advance(1);
  EXPECT_EQ(half.leg, 1U);
  EXPECT_NEAR(half.share, 0.5, 1e-12);
  (void)legs.advance(5);
  EXPECT_TRUE(legs.done());
}

TEST(Legs, OfEvenPaceHaveOneSpeedBetweenTheirRamps) {
  Legs legs;
  legs.add({Pace::Even, 2, {}});
  double last = legs.advance(Legs::ramp_s).share;
  EXPECT_NEAR(last, Legs::ramp_s / 2 / (2 - Legs::ramp_s), 1e-12) << "half the speed on average, so far";
  for (int k = 0; k < 5; ++k) {
    const double now = legs.advance(0.25).share;
    EXPECT_NEAR((now - last) / 0.25, 1 / (2 - Legs::ramp_s), 1e-12);
    last = now;
  }
}

TEST(Legs, WaitForTheToolAtTheirEnd) {
  Legs legs;
  legs.add({Pace::MinimumJerk, 1, 3});
  legs.add({Pace::MinimumJerk, 1, 0});
  EXPECT_FALSE(legs.tool());
  (void)legs.advance(0.5);
  legs.tool_done();
  EXPECT_EQ(legs.leg(), 0U) << "not due yet";
  for (int k = 0; k < 3; ++k) EXPECT_EQ(legs.advance(1).leg, 0U);
  EXPECT_EQ(legs.tool(), 3);
  legs.tool_done();
  (void)legs.advance(2);
  EXPECT_EQ(legs.tool(), 0) << "to hold nothing is something to wait for";
  legs.tool_done();
  EXPECT_TRUE(legs.done());
  EXPECT_FALSE(legs.tool());
}

TEST(ToolWatch, IsDoneWhenTheDeviceHoldsWhatIsWantedAndFailsWhenItDoesNotInTime) {
  using Verdict = ToolWatch::Verdict;
  ToolWatch tool;
  EXPECT_EQ(tool.update(2), Verdict::Idle);
  tool.want(2);
  EXPECT_EQ(tool.update(0), Verdict::UnderWay);
  EXPECT_EQ(tool.update(2), Verdict::Done);
  EXPECT_EQ(tool.update(2), Verdict::Idle);
  tool.want(1);
  int cycles = 1;
  for (; tool.update(0) == Verdict::UnderWay; ++cycles) EXPECT_TRUE(tool.busy());
  EXPECT_EQ(cycles, ToolWatch::patience_cycles);
  EXPECT_FALSE(tool.busy());
  tool.want(1);
  tool.forget();
  EXPECT_EQ(tool.update(1), Verdict::Idle);
}

}  // namespace
}  // namespace hirosco::manipulator
