// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/two_joint/kinematics.hpp"

namespace hirosco::manipulator::two_joint {

Point tip(const Geometry& geometry, const Joints& position_rad) noexcept {
  const double both = position_rad[0] + position_rad[1];
  return {geometry.l1_m * std::cos(position_rad[0]) + geometry.l2_m * std::cos(both),
          geometry.l1_m * std::sin(position_rad[0]) + geometry.l2_m * std::sin(both)};
}

Joints joints_for(const Geometry& geometry, const Point& tip_m) noexcept {
  const double l1 = geometry.l1_m;
  const double l2 = geometry.l2_m;
  const double square_m2 = tip_m[0] * tip_m[0] + tip_m[1] * tip_m[1];
  const double q2 = std::acos(std::clamp((square_m2 - l1 * l1 - l2 * l2) / (2 * l1 * l2), -1.0, 1.0));
  const double q1 = std::atan2(tip_m[1], tip_m[0]) - std::atan2(l2 * std::sin(q2), l1 + l2 * std::cos(q2));
  return {q1, q2};
}

Point tip_force(const Geometry& geometry, const Joints& position_rad, const Joints& torque_n_m) noexcept {
  const double both = position_rad[0] + position_rad[1];
  const double x2 = geometry.l2_m * std::cos(both);
  const double y2 = geometry.l2_m * std::sin(both);
  const double x = geometry.l1_m * std::cos(position_rad[0]) + x2;
  const double y = geometry.l1_m * std::sin(position_rad[0]) + y2;
  const double det = x * y2 - y * x2;  // of J = [-y -y2; x x2]
  constexpr double smallest_det_m2 = 1e-3;
  if (!(std::abs(det) >= smallest_det_m2)) return {};
  return {(x2 * torque_n_m[0] - x * torque_n_m[1]) / det, (y2 * torque_n_m[0] - y * torque_n_m[1]) / det};
}

}  // namespace hirosco::manipulator::two_joint
