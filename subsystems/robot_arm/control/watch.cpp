// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/watch.hpp"

#include <algorithm>

namespace hirosco::robot_arm {

std::optional<Finding> Watch::update(const Measured& measured, const JointVector* setpoint, Bounds bounds,
                                     const Limits& limits) noexcept {
  std::optional<Finding> worst;
  const auto look = [&](Excess what, std::size_t joint, double value, double limit, bool within) {
    const auto kind = static_cast<std::size_t>(what);
    if (!history_[kind][joint].add(!within) || told_[kind]) return;
    // The order of the kinds is not that of their gravity: the hard torque alone goes before what was found already.
    if (!worst || what == Excess::TorqueHard) worst = {what, joint, value, limit};
  };
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const JointBounds& its = bounds[joint];
    const double position = measured.position[i], speed = measured.velocity[i], torque = measured.torque[i];
    const bool without_zero = (limits.without_zero >> joint & 1) != 0;
    const double past = past_end(its, limits.past_end);
    const double lowest = its.lowest - past, highest = its.highest + past;
    look(Excess::Position, joint, position, position < lowest ? its.lowest : its.highest,
         without_zero ? std::isfinite(position) : position >= lowest && position <= highest);
    const double fastest = limits.speed_share * std::max(its.motion.velocity, its.told_velocity);
    look(Excess::Speed, joint, speed, fastest, std::abs(speed) <= fastest);
    const double soft = limits.torque_share * its.effort, hard = limits.torque_hard_share * its.effort;
    look(Excess::Torque, joint, torque, soft, std::abs(torque) <= soft);
    look(Excess::TorqueHard, joint, torque, hard, std::abs(torque) <= hard);
    const double behind = setpoint != nullptr ? (*setpoint)[i] - position : 0;
    look(Excess::Following, joint, behind, limits.following, std::abs(behind) <= limits.following);
  }
  if (!worst) return std::nullopt;
  told_[static_cast<std::size_t>(worst->what)] = true;
  if (!first_) first_ = worst->what;
  return worst;
}

}  // namespace hirosco::robot_arm
