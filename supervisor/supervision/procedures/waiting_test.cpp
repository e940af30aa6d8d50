// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/waiting.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace hirosco::supervisor {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

struct WaitingTest : ::testing::Test {
  Waiting waiting;
  const TimePoint begin{10s};
  const TimePoint deadline{12s};
  bool there{false};
  std::vector<std::string> ends;

  CommandDone keep() {
    return [this](bool success, const std::string& why) { ends.push_back(success ? "there" : why); };
  }
  void wait() {
    waiting.wait(begin, deadline, [this] { return there; }, keep());
  }
};

TEST_F(WaitingTest, WhatHoldsAlreadyIsToldAtOnceAndOnce) {
  there = true;
  wait();
  EXPECT_THAT(ends, ElementsAre("there"));
  waiting.watch(deadline);
  EXPECT_THAT(ends, SizeIs(1));
}

TEST_F(WaitingTest, WhatComesToHoldIsToldInTheNextWatchAndOnce) {
  wait();
  waiting.watch(begin);
  EXPECT_THAT(ends, IsEmpty());
  there = true;
  waiting.watch(deadline - 1ns);
  EXPECT_THAT(ends, ElementsAre("there"));
  waiting.watch(deadline);
  EXPECT_THAT(ends, SizeIs(1));
}

TEST_F(WaitingTest, WhatDoesNotHoldAtItsDeadlineIsToldSoThenAndWhatDoesIsThere) {
  wait();
  waiting.watch(deadline - 1ns);
  EXPECT_THAT(ends, IsEmpty());
  waiting.watch(deadline);
  EXPECT_THAT(ends, ElementsAre("not in its time"));
  ends.clear();
  wait();
  there = true;
  waiting.watch(deadline);
  EXPECT_THAT(ends, ElementsAre("there")) << "late to look is not late to come";
}

TEST_F(WaitingTest, WhoseTimeIsOverBeforeItBeginsDoesNotWait) {
  waiting.wait(deadline, deadline, [] { return false; }, keep());
  EXPECT_THAT(ends, ElementsAre("not in its time"));
}

TEST_F(WaitingTest, NoMoreWaitThanThereIsRoomForAndWhoEndsMakesRoom) {
  for (std::size_t i = 0; i < Waiting::most; ++i) wait();
  EXPECT_THAT(ends, IsEmpty());
  wait();
  EXPECT_THAT(ends, ElementsAre("too many wait"));
  waiting.watch(deadline);
  ends.clear();
  wait();
  EXPECT_THAT(ends, IsEmpty());
}

TEST_F(WaitingTest, WhoIsToldMayWaitForSomethingElseWhichIsLookedAtInTheNextWatch) {
  int looked_at = 0;
  waiting.wait(
      begin, deadline, [this] { return there; },
      [&](bool, const std::string&) { waiting.wait(begin, deadline, [&] { return ++looked_at > 1; }, keep()); });
  there = true;
  waiting.watch(begin);
  EXPECT_EQ(looked_at, 1) << "by wait() itself";
  waiting.watch(begin);
  EXPECT_THAT(ends, ElementsAre("there"));
}

/// Of a stage that ends many begin to wait: while all are looked at there are no more than ever.
TEST_F(WaitingTest, ThoseThatBeginToWaitWhileTheOthersAreLookedAtCountWithThem) {
  std::vector<std::string> second_ends;
  waiting.wait(
      begin, deadline, [this] { return there; },
      [&](bool, const std::string&) {
        for (std::size_t i = 0; i < Waiting::most; ++i)
          waiting.wait(
              begin, deadline, [] { return false; }, [&](bool, const std::string& why) { second_ends.push_back(why); });
      });
  for (std::size_t i = 1; i < Waiting::most; ++i) waiting.wait(begin, deadline, [] { return false; }, keep());
  there = true;
  waiting.watch(begin);
  EXPECT_THAT(second_ends, SizeIs(Waiting::most - 1)) << "only the place of the one that ended was free";
  EXPECT_THAT(second_ends, Each("too many wait"));
  waiting.watch(begin);
  waiting.wait(begin, deadline, [] { return false; }, keep());
  EXPECT_THAT(ends, ElementsAre("too many wait"));
  ends.clear();
  second_ends.clear();
  waiting.watch(deadline);
  EXPECT_THAT(ends, SizeIs(Waiting::most - 1));
  EXPECT_THAT(second_ends, ElementsAre("not in its time"));
}

}  // namespace
}  // namespace hirosco::supervisor
