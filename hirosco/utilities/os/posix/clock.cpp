// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/clock.hpp"

#include <charconv>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace hirosco {
namespace {

[[nodiscard]] Duration reading(clockid_t clock) noexcept {
  timespec value{};
  // None of these clocks can fail: the system has them and the pointer is ours.
  (void)clock_gettime(clock, &value);
  return std::chrono::seconds{value.tv_sec} + Duration{value.tv_nsec};
}

}  // namespace

std::optional<Duration> given_epoch() noexcept {
  const char* text = std::getenv(flight_epoch_variable);
  if (text == nullptr) return std::nullopt;
  const std::string_view digits{text};
  std::int64_t epoch_ns = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), epoch_ns);
  if (problem != std::errc{} || end != digits.data() + digits.size() || digits.empty()) return std::nullopt;
  return Duration{epoch_ns};
}

Duration SystemClock::calendar_epoch(Duration tai_minus_utc) noexcept {
  // The tightest of some readings: in between, the processor may be taken away.
  constexpr int readings = 5;
  Duration best{};
  Duration narrowest = Duration::max();
  for (int i = 0; i < readings; ++i) {
    const Duration before = reading(CLOCK_MONOTONIC);
    const Duration calendar = reading(CLOCK_REALTIME);
    const Duration width = reading(CLOCK_MONOTONIC) - before;
    if (width >= narrowest) continue;
    narrowest = width;
    best = calendar - before;
  }
  return best + tai_minus_utc + std::chrono::seconds{onboard_epoch_to_unix_s};
}

TimePoint SystemClock::do_now() const noexcept { return TimePoint{reading(CLOCK_MONOTONIC)}; }

OnboardTime SystemClock::do_onboard() const noexcept { return OnboardTime{reading(CLOCK_MONOTONIC) + epoch_}; }

Duration SystemClock::do_processor() const noexcept { return reading(CLOCK_THREAD_CPUTIME_ID); }

}  // namespace hirosco
