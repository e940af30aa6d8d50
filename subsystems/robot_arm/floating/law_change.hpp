// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// From one law to another without a step in torque (docs/adr/0222, 0235): what they differ by fades. Whoever pushes meanwhile is let go of, and not dropped.
/// Realtime: wait-free. Thread: the cycle.
class LawChange {
 public:
  /// As the arm that stands lets go of whoever it met, and as it takes any other law.
  static constexpr double let_go_s = 0.05, smooth_s = 0.3;

  /// In configure(), of so many joints: nothing was put out.
  void begin(Eigen::Index joints, double cycle_s) noexcept {
    last_.setZero(joints);
    kept_ = last_;
    cycle_s_ = cycle_s;
    left_s_ = 0;
    changed_ = false;
  }
  /// Another law asks for the next torque.
  void change(double fade_s) noexcept {
    changed_ = true;
    fade_s_ = fade_s;
  }
  /// Each cycle: what is to be put out of what the law in force asks for.
  [[nodiscard]] JointVector without_a_step(const JointVector& torque) noexcept {
    if (changed_) {
      kept_ = last_ - torque;
      if (!kept_.allFinite()) kept_.setZero();
      left_s_ = fade_s_;
      changed_ = false;
    } else {
      left_s_ = std::max(0.0, left_s_ - cycle_s_);
    }
    if (left_s_ <= 0) return torque;
    return torque + left_s_ / fade_s_ * kept_;
  }
  /// What is, by whoever bounds it: it is what the next law goes on from.
  void put_out(const JointVector& torque) noexcept { last_ = torque; }

 private:
  JointVector last_, kept_;
  double cycle_s_{0.001}, left_s_{0}, fade_s_{smooth_s};
  bool changed_{false};
};

}  // namespace hirosco::robot_arm
