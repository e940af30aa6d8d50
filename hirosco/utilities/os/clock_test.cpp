// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/clock.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <string>

#include <chrono>

namespace hirosco {
namespace {

TEST(SystemClock, NeverRunsBackwards) {
  const SystemClock clock;
  TimePoint last = clock.now();
  for (int i = 0; i < 10'000; ++i) {
    const TimePoint now = clock.now();
    ASSERT_GE(now, last);
    last = now;
  }
}

TEST(SystemClock, IsTheClockTheStandardLibraryCallsSteady) {
  const SystemClock clock;
  const auto before = std::chrono::steady_clock::now().time_since_epoch();
  const auto ours = clock.now().time_since_epoch();
  const auto after = std::chrono::steady_clock::now().time_since_epoch();
  EXPECT_LE(before, ours);
  EXPECT_LE(ours, after);
}

TEST(SystemClock, OnboardTimeIsTheCalendarPlus37SecondsCountedFrom1958) {
  const SystemClock clock;
  const auto before = std::chrono::system_clock::now().time_since_epoch();
  const Duration ours = clock.onboard().time_since_epoch();
  const auto after = std::chrono::system_clock::now().time_since_epoch();
  const auto days =
      std::chrono::sys_days{std::chrono::year{1970} / 1 / 1} - std::chrono::sys_days{std::chrono::year{1958} / 1 / 1};
  // The epoch is fixed once, by two readings one after the other; the calendar may be slewed since.
  constexpr Duration uncertainty = 10ms;
  EXPECT_LE(before + days + std::chrono::seconds{37}, ours + uncertainty);
  EXPECT_LE(ours, after + days + std::chrono::seconds{37} + uncertainty);
}

/// Gives this process an epoch as a flight does.
class Given {
 public:
  explicit Given(const std::string& epoch) { ::setenv(flight_epoch_variable, epoch.c_str(), 1); }
  ~Given() { ::unsetenv(flight_epoch_variable); }
  Given(const Given&) = delete;
  Given& operator=(const Given&) = delete;
};

TEST(SystemClock, KeepsTheEpochOfItsFlightWhateverTheCalendarSaysNow) {
  // As in a process that is started again after somebody has set the calendar back, or on, by a day.
  for (const Duration step : {Duration{-24h}, Duration{24h}}) {
    const Duration epoch = SystemClock{}.epoch() - step;
    const Given given{std::to_string(epoch.count())};
    const SystemClock restarted;
    EXPECT_EQ(restarted.epoch(), epoch);
    const TimePoint before = restarted.now();
    const OnboardTime ours = restarted.onboard();
    EXPECT_GE(ours.time_since_epoch(), before.time_since_epoch() + epoch);
    EXPECT_LE(ours.time_since_epoch(), restarted.now().time_since_epoch() + epoch);
  }
}

TEST(SystemClock, TakesTheCalendarWhereTheEpochGivenIsNone) {
  const Duration calendar = SystemClock{}.epoch();
  for (const char* text : {"", "x", "12x", "99999999999999999999"}) {
    const Given given{text};
    EXPECT_LT(std::chrono::abs(SystemClock{}.epoch() - calendar), 1h) << text;
  }
}

TEST(SystemClock, OffsetToUtcIsConfigurable) {
  const Duration tai = SystemClock::calendar_epoch(SystemClock::default_tai_minus_utc);
  const Duration utc = SystemClock::calendar_epoch(Duration{0});
  EXPECT_LT(std::chrono::abs(tai - utc - 37s), 10ms);
}

}  // namespace
}  // namespace hirosco
