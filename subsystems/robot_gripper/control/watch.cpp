// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/control/watch.hpp"

#include <cmath>

namespace hirosco::robot_gripper {

std::optional<Finding> Watch::update(const Measured& measured, const Fingers& fingers, const Limits& limits) noexcept {
  std::optional<Finding> found;
  const auto look = [&](Excess what, std::size_t joint, double value, double limit, bool within) {
    const auto kind = static_cast<std::size_t>(what);
    if (!history_[kind][joint].add(!within) || told_[kind]) return;
    // The force alone goes before what was found already.
    if (!found || what == Excess::Force) found = {what, joint, value, limit};
  };
  for (std::size_t i = 0; i < fingers.count(); ++i) {
    const Finger& its = fingers[i];
    const double position = measured.position[i], speed = measured.velocity[i], torque = measured.torque[i];
    const double past = limits.past_end_share * (its.highest() - its.lowest());
    const double nearest = position < its.lowest() ? its.lowest() - past : its.highest() + past;
    look(Excess::Position, i, position, nearest, position >= its.lowest() - past && position <= its.highest() + past);
    const double fastest = limits.speed_share * its.velocity, strongest = limits.force_share * its.effort;
    look(Excess::Speed, i, speed, fastest, std::abs(speed) <= fastest);
    look(Excess::Force, i, torque, strongest, std::abs(torque) <= strongest);
  }
  if (!found) return std::nullopt;
  told_[static_cast<std::size_t>(found->what)] = true;
  tripped_ = true;
  return found;
}

}  // namespace hirosco::robot_gripper
