// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/walls.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// A joint's spring before the end of its range: it takes the whole effort at the end. As far as a short cycle has it begin before that, rad or m; one that a longer cycle
/// softens begins farther away, up to such a share of the range, and beyond that takes less than the effort.
constexpr double wall = 0.1;
constexpr double widest_wall_share = 0.25;
constexpr double soft_edge = 0.02;
/// A damper before a joint's velocity begins at this share of it; it takes the whole effort in the end.
constexpr double brisk_share = 0.7;
/// No damper is stronger against what it moves, however short the cycle is.
constexpr double most_damping_per_s = 100;

}  // namespace

double strongest_damper(double moved, double fastest_rad_s) noexcept {
  return std::min(most_damping_per_s, robotics::strongest_damper_per_s(fastest_rad_s)) * moved;
}

double damper(double spring, double moved, double ratio, double fastest_rad_s) noexcept {
  return std::min(2 * ratio * std::sqrt(spring * moved), strongest_damper(moved, fastest_rad_s));
}

void FloatAims::remember(const JointVector& position) noexcept {
  if (let_go_) above_lowest_ = below_highest_ = position;
  let_go_ = false;
  for (Eigen::Index i = 0; i < position.size(); ++i) {
    above_lowest_[i] = std::max(above_lowest_[i], position[i]);
    below_highest_[i] = std::min(below_highest_[i], position[i]);
  }
}

double walls(const Aim& aim, double wanted_speed, const Measured& measured, Eigen::Index joint, double moved,
             const JointBounds& bounds, double fastest_rad_s) noexcept {
  const double position = measured.position[joint], speed = measured.velocity[joint];
  const double spring = std::min(bounds.effort / wall, fastest_rad_s * fastest_rad_s * moved);
  const double widest = std::max(wall, widest_wall_share * (bounds.highest - bounds.lowest));
  const double width = std::clamp(bounds.effort / spring, wall, widest);
  const double below = std::max(bounds.lowest, std::min(bounds.lowest + width, aim.lowest)) - position;
  const double above = position - std::min(bounds.highest, std::max(bounds.highest - width, aim.highest));
  double torque = 0;
  const double depth = std::max(below, above);
  if (depth > 0)
    torque = std::copysign(spring * depth, below - above) -
             std::min(1.0, depth / soft_edge) * damper(spring, moved, 1, fastest_rad_s) * speed;
  const double brisk = std::max(brisk_share * bounds.motion.velocity, std::abs(wanted_speed));
  const double excess = std::abs(speed) - brisk;
  if (excess <= 0) return torque;
  const double most =
      std::min(bounds.effort / ((1 - brisk_share) * bounds.motion.velocity), strongest_damper(moved, fastest_rad_s));
  return torque - std::copysign(most * excess, speed);
}

}  // namespace hirosco::robot_arm
