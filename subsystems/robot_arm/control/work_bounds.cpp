// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/work_bounds.hpp"

#include <algorithm>

namespace hirosco::robot_arm {
namespace {

[[nodiscard]] double share_within(double value, double limit) noexcept { return value > limit ? limit / value : 1.0; }

/// Of what a joint gives, so much is carried.
[[nodiscard]] double carried_of(double torque, double carried) noexcept {
  return std::clamp(carried, std::min(0.0, torque), std::max(0.0, torque));
}

}  // namespace

JointVector within_work(const JointVector& torque, const JointVector& carried, const JointVector& speed,
                        const ToolLever& lever, const WorkLimits& limits) noexcept {
  const JointVector pressing = torque - carried;
  const Vector3 force = lever.force(pressing);
  const double share = std::min(share_within(force.norm(), commanded_share * limits.force_n),
                                share_within(force.dot(lever.velocity(speed)), commanded_share * limits.tool_power_w));
  JointVector kept = torque;
  if (share < 1) kept = carried + share * pressing;
  double power = 0, driving = 0;
  for (Eigen::Index i = 0; i < kept.size(); ++i) {
    if (!(kept[i] * speed[i] > 0)) continue;
    power += kept[i] * speed[i];
    driving += (kept[i] - carried_of(kept[i], carried[i])) * speed[i];
  }
  const double beyond = power - commanded_share * limits.power_w;
  if (!(beyond > 0) || !(driving > 0)) return kept;
  const double left = std::max(0.0, 1 - beyond / driving);
  for (Eigen::Index i = 0; i < kept.size(); ++i) {
    if (!(kept[i] * speed[i] > 0)) continue;
    const double its = carried_of(kept[i], carried[i]);
    kept[i] = its + left * (kept[i] - its);
  }
  return kept;
}

}  // namespace hirosco::robot_arm
