// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/time.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <type_traits>

namespace hirosco {
namespace {

TEST(Time, EpochOffsetIsTheCalendarsFrom1958To1970) {
  using namespace std::chrono;
  const auto span = sys_days{year{1970} / January / 1} - sys_days{year{1958} / January / 1};
  EXPECT_EQ(std::chrono::seconds(span).count(), onboard_epoch_to_unix_s);
}

TEST(Time, OnboardAndMonotonicTimeDoNotMix) {
  static_assert(!std::is_convertible_v<TimePoint, OnboardTime>);
  static_assert(!std::is_invocable_v<std::minus<>, OnboardTime, TimePoint>);
}

TEST(Time, SecondsKeepTheFraction) {
  EXPECT_DOUBLE_EQ(seconds(1500ms), 1.5);
  EXPECT_DOUBLE_EQ(seconds(-1ns), -1e-9);
}

TEST(ManualClock, StandsStillUntilItIsMoved) {
  ManualClock clock{OnboardTime{100s}};
  const Clock& as_seen = clock;
  EXPECT_EQ(as_seen.now(), TimePoint{});
  clock.advance(5ms);
  clock.advance(5ms);
  EXPECT_EQ(as_seen.now(), TimePoint{10ms});
  EXPECT_EQ(as_seen.onboard(), OnboardTime{100s + 10ms});
  clock.set(TimePoint{1s});
  EXPECT_EQ(as_seen.onboard(), OnboardTime{101s});
}

}  // namespace
}  // namespace hirosco
