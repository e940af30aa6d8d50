// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/clock.hpp"

#include <gtest/gtest.h>

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
  EXPECT_LE(before + days + std::chrono::seconds{37}, ours);
  EXPECT_LE(ours, after + days + std::chrono::seconds{37});
}

TEST(SystemClock, OffsetToUtcIsConfigurable) {
  const SystemClock tai;
  const SystemClock utc{Duration{0}};
  const OnboardTime first = utc.onboard();
  const OnboardTime second = tai.onboard();
  EXPECT_GE(second - first, 37s);
}

}  // namespace
}  // namespace hirosco
