// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "hirosco/parameter/sized.hpp"
#include "robotics/dynamics/dynamics.hpp"
#include "robotics/motion/point_to_point.hpp"

/// The control of an arm that is known by its URDF file, free of the framework: numbers in, numbers out. A joint's position is in rad
/// or m, its torque in N m or N.
/// All of it: Realtime: bounded, no allocation after construction, no system call. Thread: the cycle.
namespace hirosco::robot_arm {

inline constexpr std::size_t max_joints = robotics::max_joints;
/// A number for each joint, in the order of the URDF file; those of one arm are all of one length.
using Joints = Sized<double, max_joints>;
using robotics::Jacobian;
using robotics::JointVector;
using robotics::Vector3;
using robotics::Vector6;

[[nodiscard]] inline JointVector vector_of(std::span<const double> numbers) noexcept {
  JointVector vector;
  vector.resize(static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) vector[static_cast<Eigen::Index>(i)] = numbers[i];
  return vector;
}
template <class Vector>
[[nodiscard]] Joints joints_of(const Vector& vector) noexcept {
  return Joints::of({vector.data(), static_cast<std::size_t>(vector.size())});
}

/// What a joint may do: of its URDF file, acceleration and jerk of the descriptor.
struct JointBounds {
  double lowest{-HUGE_VAL};
  double highest{HUGE_VAL};
  double effort{0};
  robotics::MotionLimits motion{};
  double told_velocity{0};  ///< of its file: who is pushed may have it, though he is led slower
};
using Bounds = std::span<const JointBounds>;

/// rad or m beyond its range, which may be that of a short slider: no more than this, nor than this share of the range.
[[nodiscard]] inline double past_end(const JointBounds& bounds, double most) noexcept {
  return most * std::min(1.0, bounds.highest - bounds.lowest);
}

/// Where the arm is to be, how fast, and what that takes.
struct Setpoint {
  JointVector position;
  JointVector velocity;
  JointVector acceleration;
};

/// One sample of the arm's sensors.
struct Measured {
  JointVector position;
  JointVector velocity;
  JointVector torque;  ///< that its drives give to its links: behind gears and their friction
};

}  // namespace hirosco::robot_arm
