// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "subsystems/manipulator/control/joints.hpp"

namespace hirosco::manipulator {

/// Share of a way that a minimum-jerk motion from rest to rest has made at the share `s` of its time.
[[nodiscard]] constexpr double minimum_jerk(double s) noexcept { return s * s * s * (10 + s * (6 * s - 15)); }

/// How fast a setpoint may move and change its speed.
struct MotionLimits {
  double speed_rad_s{1.2};
  double acceleration_rad_s2{30};
};
/// Of MOVE_TO and HOME: from rest to rest, so that half a torque limit is left for what is met on the way.
inline constexpr MotionLimits path_limits{.speed_rad_s = 1.0, .acceleration_rad_s2 = 10};

/// Shortest time in which a minimum-jerk motion of all joints stays within the limits, s.
[[nodiscard]] double shortest_duration_s(const Joints& from_rad, const Joints& to_rad,
                                         const MotionLimits& limits) noexcept;

/// Minimum-jerk motion of all joints from rest to rest: they set out, and arrive, together.
class Trajectory {
 public:
  /// `duration_s` at or below 0 arrives at once.
  void start(const Joints& from_rad, const Joints& to_rad, double duration_s) noexcept;
  /// Moves on and returns the setpoint.
  Joints advance(double span_s) noexcept;
  [[nodiscard]] Joints position_rad() const noexcept;
  [[nodiscard]] const Joints& target_rad() const noexcept { return to_; }
  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
  [[nodiscard]] double progress() const noexcept;  ///< 0..1 of the time
  [[nodiscard]] bool done() const noexcept { return past_s_ >= duration_s_; }

 private:
  Joints from_{};
  Joints to_{};
  double duration_s_{0};
  double past_s_{0};
};

/// Whether a motion arrived: judged by what is measured, not by the time that was given to it.
class Arrival {
 public:
  enum class Verdict : std::uint8_t { UnderWay, There, Missed };
  /// How long a motion may take to settle after the end of its path.
  static constexpr double patience_s = 1.0;

  void start() noexcept { waited_s_ = 0; }
  /// Called each cycle from the end of the path on: every joint has to be there.
  [[nodiscard]] Verdict judge(const Joints& measured_rad, const Joints& goal_rad, double tolerance_rad,
                              double span_s) noexcept;

 private:
  double waited_s_{0};
};

}  // namespace hirosco::manipulator
