// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/work_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// How much of `more` comes to `first` so that both together are no more than `most`. Where `first` alone is: as much as leaves them least.
[[nodiscard]] double share_within(const Vector3& first, const Vector3& more, double most) noexcept {
  const double length = more.norm();
  if (!((first + more).norm() > most) || !(length > 0)) return 1;
  const double along = first.dot(more) / length;
  const double left = most * most - first.squaredNorm() + along * along;
  return std::clamp((std::sqrt(std::max(0.0, left)) - along) / length, 0.0, 1.0);
}
[[nodiscard]] double share_within(double first, double more, double most) noexcept {
  if (!(first + more > most) || !(more > 0)) return 1;
  return std::clamp((most - first) / more, 0.0, 1.0);
}

/// Of what a joint gives, so much is carried.
[[nodiscard]] double carried_of(double torque, double carried) noexcept {
  return std::clamp(carried, std::min(0.0, torque), std::max(0.0, torque));
}

}  // namespace

JointVector within_work(const JointVector& torque, const Carried& carried, const JointVector& speed,
                        const ToolLever& lever, const WorkLimits& limits) noexcept {
  const double most_n = commanded_share * limits.force_n, most_w = commanded_share * limits.tool_power_w;
  const Vector3 velocity = lever.velocity(speed);
  const auto share_of = [&](const Vector3& first, const Vector3& more) {
    return std::min(share_within(first, more, most_n), share_within(first.dot(velocity), more.dot(velocity), most_w));
  };
  const JointVector pressing = torque - carried.known - carried.learnt;
  const Vector3 learnt_n = lever.force(carried.learnt), pressing_n = lever.force(pressing);
  const double share = share_of(learnt_n, pressing_n);
  // Where what was learnt keeps both limits, so does any share up to the least of the two; else the whole is taken back.
  const bool within = !(learnt_n.norm() > most_n) && !(learnt_n.dot(velocity) > most_w);
  const double of_all = within ? 1 : share_of(Vector3::Zero(), learnt_n + share * pressing_n);
  JointVector kept = torque;
  if (share < 1 || of_all < 1) kept = carried.known + of_all * (carried.learnt + share * pressing);
  const JointVector carries = carried.known + of_all * carried.learnt;
  double power = 0, driving = 0;
  for (Eigen::Index i = 0; i < kept.size(); ++i) {
    if (!(kept[i] * speed[i] > 0)) continue;
    power += kept[i] * speed[i];
    driving += (kept[i] - carried_of(kept[i], carries[i])) * speed[i];
  }
  const double beyond = power - commanded_share * limits.power_w;
  if (!(beyond > 0) || !(driving > 0)) return kept;
  const double left = std::max(0.0, 1 - beyond / driving);
  for (Eigen::Index i = 0; i < kept.size(); ++i) {
    if (!(kept[i] * speed[i] > 0)) continue;
    const double its = carried_of(kept[i], carries[i]);
    kept[i] = its + left * (kept[i] - its);
  }
  return kept;
}

}  // namespace hirosco::robot_arm
