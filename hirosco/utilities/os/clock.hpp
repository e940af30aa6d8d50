// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// By this variable of the environment a flight gives its epoch to every process, those restarted later, too (adr 0038).
inline constexpr const char* flight_epoch_variable = "HIROSCO_EPOCH_NS";
/// The epoch that this process was given, in nanoseconds; empty without one or when it is no number.
[[nodiscard]] std::optional<Duration> given_epoch() noexcept;

/// The operating system's clocks: now() is CLOCK_MONOTONIC; onboard() is now() and an epoch that is fixed once, so that a
/// step of the calendar never makes on-board time go back or jump. The epoch is the one the flight was given, else the
/// calendar's (CLOCK_REALTIME brought to TAI of 1958) when this object is made. processor() is CLOCK_THREAD_CPUTIME_ID, a
/// system call.
/// Realtime: wait-free. Thread: any.
class SystemClock final : public Clock {
 public:
  /// TAI - UTC since 2017-01-01.
  static constexpr Duration default_tai_minus_utc = std::chrono::seconds{37};

  SystemClock() noexcept : SystemClock{given_epoch().value_or(calendar_epoch(default_tai_minus_utc))} {}
  /// `epoch`: on-board time when the monotonic clock was zero.
  explicit SystemClock(Duration epoch) noexcept : epoch_{epoch} {}
  [[nodiscard]] static Duration calendar_epoch(Duration tai_minus_utc) noexcept;

  [[nodiscard]] Duration epoch() const noexcept { return epoch_; }

 private:
  [[nodiscard]] TimePoint do_now() const noexcept override;
  [[nodiscard]] OnboardTime do_onboard() const noexcept override;
  [[nodiscard]] Duration do_processor() const noexcept override;

  Duration epoch_;
};

}  // namespace hirosco
