// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robotics/motion/point_to_point.hpp"
#include "subsystems/robot_arm/control/braking.hpp"
#include "subsystems/robot_arm/control/joints.hpp"
#include "subsystems/robot_arm/control/power_pace.hpp"

namespace hirosco::robot_arm {

/// All joints on one path from rest to rest. Braked, or for its power, the arm stays on it: its time goes slower, as fast as the joints' accelerations
/// permit.
class PathMotion {
 public:
  PathMotion(Bounds bounds, double cycle_s) noexcept : bounds_{bounds}, cycle_s_{cycle_s} {}

  /// Each joint by the same share of its way, jerk-limited, with this share of their velocities. InvalidArgument: as of PointToPoint, and nothing is changed.
  [[nodiscard]] Result<> begin(const JointVector& from, const JointVector& goal, double speed_share,
                               const PowerPace& power) noexcept;
  /// So long it would take; infinitely, where begin() would refuse.
  [[nodiscard]] double foreseen_s(const JointVector& from, const JointVector& goal, double speed_share,
                                  const PowerPace& power) const noexcept;
  /// The setpoint of the next cycle. True: it rests there.
  [[nodiscard]] bool advance(bool braking, const PowerPace& power, Setpoint& setpoint) noexcept;
  /// Where it would come to rest if it went on for a cycle and braked then.
  [[nodiscard]] JointVector braked(bool braking) const noexcept;
  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
  /// 0 to 1.
  [[nodiscard]] double progress() const noexcept { return progress_on(path_, on_); }

 private:
  [[nodiscard]] Result<robotics::PointToPoint> plan(const JointVector& from, const JointVector& goal,
                                                    double speed_share) const noexcept;
  [[nodiscard]] static double with_power_s(const robotics::PointToPoint& path, const PowerPace& power) noexcept;
  [[nodiscard]] double quickening() const noexcept;

  Bounds bounds_;
  double cycle_s_;
  robotics::PointToPoint path_{};
  robotics::PointToPoint::Sample sample_{};
  OnWay on_{};
  double duration_s_{0};
};

}  // namespace hirosco::robot_arm
