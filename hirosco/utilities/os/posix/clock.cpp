// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/clock.hpp"

#include <ctime>

namespace hirosco {
namespace {

[[nodiscard]] Duration reading(clockid_t clock) noexcept {
  timespec value{};
  // Neither clock can fail: both are mandatory and the pointer is ours.
  (void)clock_gettime(clock, &value);
  return std::chrono::seconds{value.tv_sec} + Duration{value.tv_nsec};
}

}  // namespace

TimePoint SystemClock::do_now() const noexcept { return TimePoint{reading(CLOCK_MONOTONIC)}; }

OnboardTime SystemClock::do_onboard() const noexcept { return OnboardTime{reading(CLOCK_REALTIME) + unix_to_onboard_}; }

}  // namespace hirosco
