// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "hirosco/utilities/result.hpp"
#include "robotics/dynamics/dynamics.hpp"

/// How a robot comes from one place to another.
namespace hirosco::robotics {

/// What a joint may do on its way, each above 0.
struct MotionLimits {
  double velocity{0};                ///< rad/s or m/s
  double acceleration{0};            ///< rad/s2 or m/s2
  double jerk{0};                    ///< rad/s3 or m/s3
};

/// From rest to rest, all joints at once: each keeps its limits of velocity, acceleration and jerk, all begin and end together, and none could be
/// there sooner than the one that takes longest. That one goes in the least time there is; the others follow the same kind of curve, stretched.
/// Realtime: bounded, closed forms; nothing allocates.  Thread: one that plans; any number that read.
class PointToPoint {
 public:
  /// InvalidArgument: numbers of joints differ, a place is no number or a limit not above 0.
  [[nodiscard]] static Result<PointToPoint> plan(const JointVector& from, const JointVector& to,
                                                 std::span<const MotionLimits> limits) noexcept;
  /// The same on the straight line from one place to the other: all joints follow one curve, the quickest that every one of them can.
  [[nodiscard]] static Result<PointToPoint> plan_straight(const JointVector& from, const JointVector& to,
                                                          std::span<const MotionLimits> limits) noexcept;

  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
  struct Sample {
    JointVector position;
    JointVector velocity;
    JointVector acceleration;
  };
  /// Before the beginning and after the end it rests.  Realtime: wait-free.
  void at(double t_s, Sample& sample) const noexcept;

 private:
  /// Seven pieces of constant jerk, symmetric about the middle: up, steady, down; coast; down, steady, up.
  struct Curve {
    double start{0};
    double way{0};  ///< signed
    double jerk{0};  ///< of the pieces, before stretching
    double ramp{0};  ///< how long a piece of jerk is, s
    double steady{0};  ///< how long a piece of steady acceleration is, s
    double coast{0};  ///< s
    [[nodiscard]] double duration() const noexcept { return 4 * ramp + 2 * steady + coast; }
  };
  struct Point {
    double position{0};
    double velocity{0};
    double acceleration{0};
  };
  [[nodiscard]] static Result<> check(const JointVector& from, const JointVector& to,
                                      std::span<const MotionLimits> limits) noexcept;
  [[nodiscard]] static Curve quickest(double way, const MotionLimits& limits) noexcept;
  [[nodiscard]] static Point first_half(const Curve& curve, double t_s) noexcept;

  std::array<Curve, max_joints> curves_{};
  Eigen::Index joints_{0};
  double duration_s_{0};
};

}  // namespace hirosco::robotics
