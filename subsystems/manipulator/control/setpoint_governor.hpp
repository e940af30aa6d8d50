// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/manipulator/control/trajectory.hpp"

/// What keeps declared ranges from being combined into more than the declared force (adr 0034): nothing that is asked of
/// the arm reaches the control law faster or harder than these bounds, whatever gains, durations or hands ask for.
namespace hirosco::manipulator {

/// What stands around an arm and could be met.
class Surface {
 public:
  virtual ~Surface() = default;
  /// How far from it an arm in this position is, m; negative behind the surface.
  [[nodiscard]] virtual double gap_m(const Joints& position_rad) const noexcept = 0;
};

/// The setpoint that the control law is given, behind the one that is asked for.
class SetpointGovernor {
 public:
  struct Bounds {
    MotionLimits motion{};
    /// The setpoint is no farther from the motor than this: an arm that cannot follow is not pulled ever harder, and a gain
    /// that comes later finds no distance that grew meanwhile.
    double lead_rad{0.05};
    /// Towards the surface: at it, and how much faster per metre of distance.
    double contact_speed_m_s{0.060};
    double approach_per_s{20};
  };

  /// `surface` outlives the governor; nullptr: nothing stands around the arm.
  explicit SetpointGovernor(const Surface* surface) noexcept : surface_{surface} {}
  /// Stands there from now on.
  void reset(const Joints& setpoint_rad) noexcept;
  /// Goes after `asked_rad` within the bounds; one that moves within them is followed without lag. What is no number asks
  /// for nothing.
  Joints advance(const Joints& asked_rad, const Joints& motor_rad, const Bounds& bounds, double span_s) noexcept;

  /// What is asked for in steps smaller than this passes as it is: samples of a slow link are no motion of their own.
  static constexpr double grain_rad = 2e-3;

 private:
  void slow_down_before_the_surface(const Joints& from_rad, const Bounds& bounds, double span_s) noexcept;

  const Surface* surface_;
  Joints asked_{};
  Joints setpoint_{};
  Joints speed_{};
};

/// The bounds under which a joint torque of `effort_n_m` suffices: fast enough for an operator's hand at 15 N m, and in
/// proportion where the limit was raised.
[[nodiscard]] SetpointGovernor::Bounds bounds_for(double effort_n_m, double kp_n_m_per_rad) noexcept;

}  // namespace hirosco::manipulator
