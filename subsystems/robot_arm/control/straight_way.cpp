// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/straight_way.hpp"

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/control/trail.hpp"

namespace hirosco::robot_arm {

void StraightWay::begin(const JointVector& from, const JointVector& goal, double cycle_s) noexcept {
  from_ = from;
  goal_ = goal;
  step_ = 0;
  const double looks = std::ceil(apart(from, goal) / spacing);
  // What is a cycle but for its last digits is one.
  const double may_be = std::floor(longest_s / cycle_s + 1e-6);
  steps_ = static_cast<std::size_t>(std::max(1.0, std::min({looks, may_be, static_cast<double>(most)})));
}

bool StraightWay::step() noexcept {
  if (step_ >= steps_) return false;
  ++step_;
  return true;
}

}  // namespace hirosco::robot_arm
