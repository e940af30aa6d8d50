// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/cycle_pace.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hirosco {
namespace {

descriptor::Configuration by_clock() {
  descriptor::Configuration made;
  made.sampling = 10ms;
  return made;
}
descriptor::Configuration by_samples() {
  descriptor::Configuration made = by_clock();
  made.started_by = "SAMPLES";
  made.least = 2ms;
  return made;
}

TEST(CyclePace, ByTheClockEveryCycleCountsAndTheNextIsOnTheGrid) {
  CyclePace pace;
  pace.begin(by_clock(), true);
  for (const Duration late : {0ms, 1ms, 9ms}) {
    const auto start = pace.start(TimePoint{10ms}, TimePoint{10ms + late});
    EXPECT_EQ(start.planned, TimePoint{10ms});
    EXPECT_FALSE(start.arrived);
    EXPECT_TRUE(start.counts);
  }
  EXPECT_EQ(pace.next(TimePoint{10ms}, TimePoint{20ms}).due, TimePoint{20ms});
  const auto missed = pace.next(TimePoint{10ms}, TimePoint{41ms});
  EXPECT_EQ(missed.due, TimePoint{50ms});
  EXPECT_EQ(missed.skipped, 3u);
  EXPECT_FALSE(pace.wait().arrived());
}

TEST(CyclePace, ACycleThatASampleStartsCountsFromItsBeginning) {
  CyclePace pace;
  pace.begin(by_samples(), true);
  const auto first = pace.start(TimePoint{10ms}, TimePoint{10ms + 100us});
  EXPECT_FALSE(first.arrived) << "overdue";
  EXPECT_EQ(first.planned, TimePoint{10ms});
  EXPECT_EQ(pace.next(first.planned, TimePoint{11ms}).due, TimePoint{20ms});
  const auto second = pace.start(TimePoint{20ms}, TimePoint{13ms});
  EXPECT_TRUE(second.arrived);
  EXPECT_EQ(second.planned, TimePoint{13ms});
  EXPECT_EQ(pace.wait().earliest, TimePoint{15ms});
  EXPECT_EQ(pace.next(second.planned, TimePoint{14ms}).due, TimePoint{23ms});
  const auto late = pace.next(second.planned, TimePoint{40ms});
  EXPECT_EQ(late.due, TimePoint{40ms}) << "at once";
  EXPECT_EQ(late.skipped, 0u) << "there is no grid to miss";
}

/// Whatever a producer does, a limit counted in cycles lasts as long as its waits: never shorter, and longer by no more than one.
TEST(CyclePace, NoProducerMakesALimitShort) {
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    std::mt19937 random{seed};
    CyclePace pace;
    pace.begin(by_samples(), true);
    const TimePoint began{1s};
    TimePoint due = began, now = began;
    std::int64_t counted = 0;
    for (int cycle = 0; cycle < 500; ++cycle) {
      // A sample arrives at any time from the least distance on, or none before the clock.
      const TimePoint arrives = cycle == 0 ? due : pace.wait().earliest + std::chrono::microseconds{random() % 12'000};
      now = std::min(due, arrives);
      const auto start = pace.start(due, now);
      counted += start.counts ? 1 : 0;
      const auto whole = (now - began) / by_samples().sampling + 1;
      ASSERT_LE(counted, whole) << seed << ' ' << cycle;
      ASSERT_GE(counted, whole - 1) << seed << ' ' << cycle;
      due = pace.next(start.planned, now + 100us).due;
    }
  }
}

TEST(CyclePace, LimitsOfAnotherConfigurationCountFromItsFirstCycleHoweverSoonThatComes) {
  CyclePace pace;
  pace.begin(by_samples(), true);
  EXPECT_TRUE(pace.start(TimePoint{100ms}, TimePoint{100ms}).counts);
  pace.begin(by_samples(), true);
  EXPECT_TRUE(pace.start(TimePoint{104ms}, TimePoint{104ms}).counts);
  EXPECT_FALSE(pace.start(TimePoint{113ms}, TimePoint{113ms}).counts);
  EXPECT_TRUE(pace.start(TimePoint{114ms}, TimePoint{114ms}).counts);
}

TEST(CyclePace, APauseOfTheWholeComputerCountsOnce) {
  CyclePace pace;
  pace.begin(by_samples(), true);
  EXPECT_TRUE(pace.start(TimePoint{10ms}, TimePoint{10ms}).counts);
  const auto late = pace.start(TimePoint{20ms}, TimePoint{2s});
  EXPECT_TRUE(late.counts);
  TimePoint due = pace.next(late.planned, TimePoint{2s}).due;
  ASSERT_EQ(due, TimePoint{2s});
  int counted = 0;
  for (TimePoint now{2s}; now < TimePoint{2s + 50ms}; now += 2ms) {
    const auto start = pace.start(due, now);
    counted += start.counts ? 1 : 0;
    due = pace.next(start.planned, now).due;
  }
  EXPECT_EQ(counted, 5) << "what was missed is not made up for";
}

TEST(CyclePace, WaitsForAnotherWordThanBeforeItReadAsLongAsThatIsReliedOn) {
  CyclePace pace;
  pace.begin(by_samples(), true);
  std::uint32_t word = 7;
  pace.look(&word);
  pace.rely(true);
  EXPECT_FALSE(pace.wait().arrived());
  word = 8;
  EXPECT_TRUE(pace.wait().arrived());
  pace.look(&word);
  EXPECT_FALSE(pace.wait().arrived());
  word = 9;
  pace.rely(false);
  EXPECT_FALSE(pace.wait().arrived()) << "the clock goes on alone";
  pace.look(nullptr);
  pace.rely(true);
  EXPECT_FALSE(pace.wait().arrived()) << "no link";
  pace.look(&word);
  pace.begin(by_clock(), true);
  EXPECT_EQ(pace.wait().word, nullptr) << "another configuration";
}

TEST(CyclePace, SpinsWhereItsConfigurationAsksForItAndItsPlatformLetsIt) {
  descriptor::Configuration asks = by_clock();
  CyclePace pace;
  pace.begin(asks, true);
  EXPECT_EQ(pace.wait().spin, 0us) << "off where nothing is said";
  asks.spin = 80us;
  pace.begin(asks, false);
  EXPECT_EQ(pace.wait().spin, 0us);
  pace.begin(asks, true);
  EXPECT_EQ(pace.wait().spin, 80us);
  pace.look(nullptr);
  pace.rely(false);
  EXPECT_EQ(pace.wait().spin, 80us) << "whatever links do";
}

}  // namespace
}  // namespace hirosco
