// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "subsystems/robot_arm/control/preferred_posture.hpp"
#include "subsystems/robot_arm/floating/floating_model.hpp"

namespace hirosco::robot_arm {

/// What the joints of an arm on a base that floats keep to.
enum class ToolLaw : std::uint8_t {
  FixedBase,  ///< nothing of the tool; a line of the tool counts on a base that stands
  InertialTrack,  ///< the tool's pose in inertial axes; the base turns as it will
  AttitudeHold,  ///< the tool's place, and no rotation of the base
};

/// Below it AttitudeHold is refused: joints would have to run.
inline constexpr double least_conditioning = 0.05;

/// Joints follow the velocities that are asked of them with it, 1/s: of the longest cycle that is taken (docs/adr/0193) a quarter of what leaves it stable.
inline constexpr double followed_per_s = 40;
/// Likewise with a payload that is said to be there, 1/s: no faster than leaves it half of what is stable with that cycle where the payload is not there (docs/adr/0222).
[[nodiscard]] double followed_with(double heavier, double cycle_s) noexcept;

/// Where the tool is to be, and how fast it is to move and to turn, in inertial axes. AttitudeHold turns no tool.
struct ToolGoal {
  robotics::Pose pose;
  Vector3 velocity_m_s{Vector3::Zero()};
  Vector3 turning_rad_s{Vector3::Zero()};
};

/// By which rotation, rad, `is` is behind `wanted`, in the axes in which both stand.
[[nodiscard]] Vector3 rotation_between(const robotics::Matrix3& is, const robotics::Matrix3& wanted) noexcept;

/// To where joints go, rad/s or m/s, that a tool leaves free while it goes with this share of its full speed (docs/adr/0235): none by more than a quarter of its velocity.
[[nodiscard]] JointVector drawn_to(const PreferredPosture& preferred, const JointVector& position, Bounds bounds,
                                   double share) noexcept;

/// Joint velocities by damped least squares, weighted near the ends of ranges (range_ends.hpp). `base_kept`: the attitude that AttitudeHold keeps,
/// `base`: the one that is. `drawn`: with which joints go besides, as far as that moves nothing of it; none: they go no farther than they have to.
/// Realtime: wait-free.
[[nodiscard]] JointVector tool_rates(ToolLaw law, const FloatingModel& model, Bounds bounds, const ToolGoal& goal,
                                     const robotics::Matrix3& base, const robotics::Matrix3& base_kept,
                                     const JointVector* drawn = nullptr) noexcept;

/// All slower by one factor, so that none is faster than its own. What is no number becomes a stop.
void slow_down(JointVector& rates, Bounds bounds) noexcept;

/// What makes joints as fast as that, held to their efforts.
[[nodiscard]] JointVector joint_torque(const FloatingModel& model, const JointVector& wanted_rates,
                                       const JointVector& rates, Bounds bounds, double per_s = followed_per_s) noexcept;

/// From rest to rest in so long, without a step in acceleration: share of the way, and its rate.
struct Course {
  double share{1};
  double per_s{0};
};
[[nodiscard]] Course course(double t_s, double duration_s) noexcept;
/// The fastest rate of a course.
inline constexpr double fastest_of_course = 1.875;
/// As a share of that.
[[nodiscard]] inline double pace(const Course& at, double duration_s) noexcept {
  return at.per_s * duration_s / fastest_of_course;
}

}  // namespace hirosco::robot_arm
