// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/realtime_watch.hpp"

#include <gtest/gtest.h>

namespace hirosco {
namespace {

struct ARealtimeWatch : ::testing::Test {
  ARealtimeWatch() { watch.begin(100ms); }
  /// How often it is told in so many cycles that all do this.
  int told(int cycles, const RealtimeUses& of_each) {
    int times = 0;
    for (int i = 0; i < cycles; ++i) times += watch.account(of_each) ? 1 : 0;
    return times;
  }
  RealtimeWatch watch;
};

TEST_F(ARealtimeWatch, HasNothingToTellOfCyclesThatKeepToIt) { EXPECT_EQ(told(1000, {}), 0); }

TEST_F(ARealtimeWatch, TellsTheFirstUseAtOnceWhateverItIs) {
  for (const RealtimeUses& each : {RealtimeUses{.heap = 1}, RealtimeUses{.locks = 1}, RealtimeUses{.outputs = 1}}) {
    watch.begin(100ms);
    EXPECT_EQ(told(3, {}), 0);
    EXPECT_TRUE(watch.account(each));
    EXPECT_EQ(watch.sum(), each);
  }
}

TEST_F(ARealtimeWatch, TellsWhoGoesOnOnceASecondAndNothingIsLeftOut) {
  EXPECT_EQ(told(35, {.heap = 2, .locks = 1}), 4);
  EXPECT_EQ(watch.sum(), (RealtimeUses{.heap = 70, .locks = 35}));
  EXPECT_EQ(told(30, {}), 1) << "what came since it was told last";
  EXPECT_EQ(told(30, {}), 0);
}

TEST_F(ARealtimeWatch, BeginsAnewWithEachConfiguration) {
  EXPECT_EQ(told(1, {.outputs = 5}), 1);
  watch.begin(10s);
  EXPECT_EQ(watch.sum(), RealtimeUses{});
  EXPECT_EQ(told(3, {.outputs = 1}), 3) << "cycles that are longer than a second are told each";
}

}  // namespace
}  // namespace hirosco
