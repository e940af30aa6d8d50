// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/floating/tool_law.hpp"

namespace hirosco::robot_arm {

/// How joints come to rest that are not to go where they go: all slower by the same share of what they had, along a straight way of theirs, so that it is
/// known where that ends before it begins. To ask for no velocity at once would take 40/s of it, which for the shoulder at its fastest are 290 N m of 80.
/// Realtime: wait-free. Thread: one.
class StopRamp {
 public:
  /// From any velocity: what the drives' own brakes may take, stop_within_ms of ARM, whose ramp goes no farther. With the fastest joint 0.4 rad/s2.
  static constexpr double span_s = 0.5;

  /// In which so many times the accelerations of motions bring them to rest.
  [[nodiscard]] static double span_of(const JointVector& rates, Bounds bounds, double times) noexcept {
    double span = 0;
    for (std::size_t i = 0; i < bounds.size(); ++i)
      span = std::max(span, std::abs(rates[static_cast<Eigen::Index>(i)]) / (times * bounds[i].motion.acceleration));
    return span;
  }

  /// In a cycle that puts these out still.
  void begin(const JointVector& rates, double in_s = span_s) noexcept {
    from_ = rates;
    left_s_ = begun_s_ = in_s;
  }
  void go_on(double cycle_s) noexcept { left_s_ = std::max(0.0, left_s_ - cycle_s); }
  [[nodiscard]] bool over() const noexcept { return left_s_ <= 0; }
  /// rad/s or m/s of each joint.
  [[nodiscard]] JointVector rates() const noexcept { return left_s_ / begun_s_ * from_; }

  /// Which way joints go that begin now, in a cycle that puts `rates` out, until they rest: who is asked for a velocity has it later, and comes farther by
  /// what he has now. No estimate: of the ramp and of the law that follows it (`per_s`), within a cycle's way.
  [[nodiscard]] static JointVector way(const JointVector& rates, const JointVector& measured, double cycle_s,
                                       double per_s = followed_per_s) noexcept {
    return (span_s / 2 + cycle_s) * rates + measured / per_s;
  }

 private:
  JointVector from_;
  double left_s_{0}, begun_s_{span_s};
};

}  // namespace hirosco::robot_arm
