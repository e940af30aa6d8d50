// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>

namespace hirosco {

/// All time spans are integer nanoseconds.
using Duration = std::chrono::nanoseconds;
using namespace std::chrono_literals;

/// The clock that drives loops: monotonic, shared by all processes of a node. Only its tag exists; readings come from a
/// `Clock` that is passed in.
struct MonotonicTag {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<MonotonicTag>;
  static constexpr bool is_steady = true;
};
using TimePoint = MonotonicTag::time_point;

/// On-board time: nanoseconds of TAI since 1958-01-01 (PUS-C tailoring, CUC epoch 1958).
struct OnboardTag {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<OnboardTag>;
  static constexpr bool is_steady = false;
};
using OnboardTime = OnboardTag::time_point;

/// 1958-01-01 to 1970-01-01 in seconds.
inline constexpr std::int64_t onboard_epoch_to_unix_s = 378'691'200;

[[nodiscard]] constexpr double seconds(Duration span) noexcept { return std::chrono::duration<double>(span).count(); }

/// A span for a word of 32 bits: 0 to about 4.3 s, what lies beyond is that.
[[nodiscard]] constexpr std::uint32_t clamped_ns(Duration span) noexcept {
  return static_cast<std::uint32_t>(
      std::clamp<std::int64_t>(span.count(), 0, std::numeric_limits<std::uint32_t>::max()));
}

/// Where time comes from. The real one reads the operating system, the simulated one a counter.
/// Realtime: wait-free. Thread: any.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] TimePoint now() const noexcept { return do_now(); }
  [[nodiscard]] OnboardTime onboard() const noexcept { return do_onboard(); }
  /// What the calling thread has used of a processor since it began; always zero where time is virtual and work takes none.
  [[nodiscard]] Duration processor() const noexcept { return do_processor(); }

 private:
  [[nodiscard]] virtual TimePoint do_now() const noexcept = 0;
  [[nodiscard]] virtual OnboardTime do_onboard() const noexcept = 0;
  [[nodiscard]] virtual Duration do_processor() const noexcept { return {}; }
};

/// Virtual time: stands still until somebody moves it. Ships for tests and for the simulated spacecraft.
class ManualClock final : public Clock {
 public:
  explicit ManualClock(OnboardTime start = OnboardTime{std::chrono::seconds{2'145'916'837}}) : onboard_start_{start} {}
  void set(TimePoint now) noexcept { now_ = now; }
  void advance(Duration span) noexcept { now_ += span; }
  /// Of whichever thread asks.
  void use_processor(Duration span) noexcept { processor_ += span; }

 private:
  [[nodiscard]] TimePoint do_now() const noexcept override { return now_; }
  [[nodiscard]] OnboardTime do_onboard() const noexcept override { return onboard_start_ + now_.time_since_epoch(); }
  [[nodiscard]] Duration do_processor() const noexcept override { return processor_; }

  TimePoint now_{};
  Duration processor_{};
  OnboardTime onboard_start_;
};

}  // namespace hirosco
