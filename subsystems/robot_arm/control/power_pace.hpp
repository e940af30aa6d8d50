// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// How fast a motion may go for the power of all joints: each of them is taken to give what it holds, and as much of its effort besides as
/// accelerations, friction and a load that nobody declared may take. So a motion goes slower beforehand, and is not stopped on its way.
class PowerPace {
 public:
  void set(const JointVector& held, Bounds bounds, double limit_w) noexcept {
    most_.setZero(held.size());
    for (Eigen::Index i = 0; i < held.size(); ++i)
      most_[i] = std::abs(held[i]) + besides_share * bounds[static_cast<std::size_t>(i)].effort;
    planned_w_ = planned_share * limit_w;
  }
  /// Of these rates; 1: with all of them.
  [[nodiscard]] double share(const JointVector& rates) const noexcept {
    const double power_w = power(rates);
    return power_w > planned_w_ ? planned_w_ / power_w : 1.0;
  }
  /// What these rates are taken to need.
  [[nodiscard]] double power(const JointVector& rates) const noexcept {
    double power_w = 0;
    for (Eigen::Index i = 0; i < std::min(rates.size(), most_.size()); ++i) power_w += most_[i] * std::abs(rates[i]);
    return power_w;
  }
  /// From rates `now` to `next`: of what joints get faster by, the share that leaves the power what it may be; others slow down in full.
  [[nodiscard]] double quickening_share(const JointVector& now, const JointVector& next) const noexcept {
    const double power_w = power(next);
    if (!(power_w > planned_w_)) return 1;
    double more_w = 0;
    for (Eigen::Index i = 0; i < std::min(next.size(), most_.size()); ++i)
      more_w += most_[i] * std::max(0.0, std::abs(next[i]) - std::abs(now[i]));
    return more_w > 0 ? std::clamp(1 - (power_w - planned_w_) / more_w, 0.0, 1.0) : 1.0;
  }

 private:
  static constexpr double besides_share = 0.3, planned_share = 0.8;
  JointVector most_;  ///< N m or N of each joint
  double planned_w_{HUGE_VAL};
};

}  // namespace hirosco::robot_arm
