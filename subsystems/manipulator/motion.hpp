// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/manipulator/control_law.hpp"
#include "subsystems/manipulator/script.hpp"

/// What keeps declared ranges from being combined into more than the declared force (adr 0034): nothing that is asked of
/// the arm reaches the control law faster or harder than these bounds, whatever gains, durations or hands ask for.
/// All of it: Realtime: bounded, no allocation, no system call. Thread: the cycle.
namespace hirosco::manipulator {

/// How fast a setpoint may move and change its speed.
struct MotionLimits {
  double speed_rad_s{1.2};
  double acceleration_rad_s2{30};
};
/// Of MOVE_TO and HOME: from rest to rest, so that half a torque limit is left for what is met on the way.
inline constexpr MotionLimits path_limits{.speed_rad_s = 1.0, .acceleration_rad_s2 = 10};

/// Shortest time in which a minimum-jerk motion stays within the limits, s.
[[nodiscard]] double shortest_duration_s(const Joints& from_rad, const Joints& to_rad,
                                         const MotionLimits& limits) noexcept;

/// Gains on their way to the wanted ones: they change at a bounded rate, so that a new gain is never a blow.
class GainRamp {
 public:
  static constexpr double kp_rate_per_s = 500;
  static constexpr double kd_rate_per_s = 50;

  /// At once: for a controller that begins at rest.
  void reset(const Gains& gains) noexcept { now_ = gains; }
  /// Moves on towards `wanted` and returns what holds now.
  const Gains& advance(const Gains& wanted, double span_s) noexcept;
  [[nodiscard]] const Gains& now() const noexcept { return now_; }
  [[nodiscard]] bool reached(const Gains& wanted) const noexcept {
    return now_.kp_n_m_per_rad == wanted.kp_n_m_per_rad && now_.kd_n_m_s_per_rad == wanted.kd_n_m_s_per_rad;
  }

 private:
  Gains now_{};
};

/// The setpoint that the control law is given, behind the one that is asked for.
class SetpointGovernor {
 public:
  struct Bounds {
    MotionLimits motion{};
    /// The setpoint is no farther from the motor than this: an arm that cannot follow is not pulled ever harder, and a gain
    /// that comes later finds no distance that grew meanwhile.
    double lead_rad{0.05};
    /// Of the tip towards the contour: at the contour, and how much faster per metre of distance.
    double contact_speed_m_s{0.060};
    double approach_per_s{20};
  };

  explicit SetpointGovernor(const Geometry& geometry) noexcept : geometry_{geometry} {}
  /// Stands there from now on.
  void reset(const Joints& setpoint_rad) noexcept;
  /// Goes after `asked_rad` within the bounds; one that moves within them is followed without lag. What is no number asks
  /// for nothing.
  Joints advance(const Joints& asked_rad, const Joints& motor_rad, const Bounds& bounds, double span_s) noexcept;

  /// What is asked for in steps smaller than this passes as it is: samples of a slow link are no motion of their own.
  static constexpr double grain_rad = 2e-3;

 private:
  void slow_down_before_the_contour(const Joints& from_rad, const Bounds& bounds, double span_s) noexcept;

  Geometry geometry_;
  Joints asked_{};
  Joints setpoint_{};
  Joints speed_{};
};

/// The bounds under which a joint torque of `effort_n_m` suffices: fast enough for an operator's hand at 15 N m, and in
/// proportion where the limit was raised.
[[nodiscard]] SetpointGovernor::Bounds bounds_for(double effort_n_m, double kp_n_m_per_rad) noexcept;

/// Whether a motion arrived: judged by what is measured, not by the time that was given to it.
class Arrival {
 public:
  enum class Verdict : std::uint8_t { UnderWay, There, Missed };
  /// How long a motion may take to settle after the end of its path.
  static constexpr double patience_s = 1.0;

  void start() noexcept { waited_s_ = 0; }
  /// Called each cycle from the end of the path on.
  [[nodiscard]] Verdict judge(const Joints& measured_rad, const Joints& goal_rad, double tolerance_rad,
                              double span_s) noexcept;
  /// Of the worse joint, as last judged; rad.
  [[nodiscard]] double error_rad() const noexcept { return error_rad_; }

 private:
  double waited_s_{0};
  double error_rad_{0};
};

}  // namespace hirosco::manipulator
