// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// The operating system's clocks: now() is CLOCK_MONOTONIC, onboard() is CLOCK_REALTIME brought to TAI of 1958.
/// Realtime: wait-free. Thread: any.
class SystemClock final : public Clock {
 public:
  /// TAI - UTC since 2017-01-01.
  static constexpr Duration default_tai_minus_utc = std::chrono::seconds{37};

  explicit SystemClock(Duration tai_minus_utc = default_tai_minus_utc) noexcept
      : unix_to_onboard_{tai_minus_utc + std::chrono::seconds{onboard_epoch_to_unix_s}} {}

 private:
  [[nodiscard]] TimePoint do_now() const noexcept override;
  [[nodiscard]] OnboardTime do_onboard() const noexcept override;

  Duration unix_to_onboard_;
};

}  // namespace hirosco
