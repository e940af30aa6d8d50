// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/torque_drive.hpp"

#include <algorithm>

#include "robotics/motion/sampled_rates.hpp"
#include "subsystems/robot_arm/control/work_bounds.hpp"

namespace hirosco::robot_arm {
namespace {

/// So steeply a torque is taken back before a speed, of what the joint moves, and no steeper than a damper may be with such a cycle.
constexpr double taken_back_per_s = 100;
constexpr double fast_share = 0.9, braking_acceleration_share = 0.8;
/// Before the end of a range, rad or m: nobody is driven into it.
constexpr double end_strip = 0.01;
constexpr double comes_in_s = 0.05;
constexpr double least_moved = 1e-6;

/// How fast a joint may go towards an end that is so far away.
[[nodiscard]] double fastest_towards(double left, const JointBounds& bounds) noexcept {
  const double fast = fast_share * bounds.motion.velocity;
  if (!(left > end_strip)) return 0;
  return std::min(fast, std::sqrt(2 * braking_acceleration_share * bounds.motion.acceleration * (left - end_strip)));
}

}  // namespace

void TorqueDrive::begin(Eigen::Index joints) noexcept {
  wanted_.setZero(joints);
  smooth_ = reached_ = wanted_;
  driven_ = {wanted_, wanted_};
}

const Driven& TorqueDrive::step(const Measured& measured, const Carried& carried, Bounds bounds, double torque_share,
                                double cycle_s) noexcept {
  smooth_ += std::min(1.0, cycle_s / comes_in_s) * (wanted_ - smooth_);
  const double steepest_per_s =
      std::min(taken_back_per_s, robotics::strongest_damper_per_s(robotics::fastest_rad_s(cycle_s)));
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const JointBounds& its = bounds[joint];
    const double speed = measured.velocity[i], position = measured.position[i];
    const double damper = steepest_per_s * std::max(carried.moved[i], least_moved);
    if (!std::isfinite(reached_[i])) reached_[i] = 0;  // a sample was no number
    const double side = smooth_[i] < 0 ? -1.0 : 1.0, wanted = std::abs(smooth_[i]), along = side * speed;
    const double faster = std::max(side * reached_[i], along) + its.motion.acceleration * cycle_s;
    const double reached = std::min(faster, along + wanted / damper);
    reached_[i] = side * reached;
    const double torque = side * std::clamp(damper * (reached - along), 0.0, wanted);
    const double up = fastest_towards(its.highest - position, its), down = fastest_towards(position - its.lowest, its);
    const double kept = std::clamp(torque, -damper * (down + speed), damper * (up - speed));
    // All together within the torque that stops it; who holds more than that already is given nothing on top.
    const double most = commanded_share * torque_share * its.effort;
    const double lowest = std::min(0.0, -most - carried.held[i]), highest = std::max(0.0, most - carried.held[i]);
    const double driving = std::clamp(kept, std::min(0.0, torque), std::max(0.0, torque));
    driven_.torque[i] = std::clamp(driving, lowest, highest);
    driven_.brake[i] = std::clamp(kept - driving, lowest, highest);
  }
  return driven_;
}

}  // namespace hirosco::robot_arm
