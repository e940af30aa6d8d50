// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "subsystems/manipulator/control/joints.hpp"

/// What is planar and two-jointed of the demonstrator's arm (paper 5).
/// All of it: Realtime: bounded, no allocation, no system call. Thread: the cycle.
namespace hirosco::manipulator::two_joint {

/// In the arm's plane: x, y.
using Point = std::array<double, 2>;

/// Kinematics as the controller believes them.
struct Geometry {
  double l1_m{0.25};
  double l2_m{0.22};
};
[[nodiscard]] Point tip(const Geometry& geometry, const Joints& position_rad) noexcept;
/// Joint angles that bring the tip there, second joint bent as at home; the nearest ones where it is out of reach.
[[nodiscard]] Joints joints_for(const Geometry& geometry, const Point& tip_m) noexcept;
/// Force of the tip on its surroundings that the joint torques tell of at rest: solves J^T f = tau. Zero where the arm is
/// closer to singular than |det J| < 1e-3 m2.
[[nodiscard]] Point tip_force(const Geometry& geometry, const Joints& position_rad, const Joints& torque_n_m) noexcept;

}  // namespace hirosco::manipulator::two_joint
