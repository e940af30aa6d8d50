// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// From the law of velocities to that of an arm that floats, and back, without a step in torque (docs/adr/0222): what they differ by fades. Whoever pushes meanwhile is let go of, and not dropped.
/// Realtime: wait-free. Thread: the cycle.
class LawChange {
 public:
  /// As the arm that stands lets go of whoever it met.
  static constexpr double fade_s = 0.05;

  /// In configure(), of so many joints.
  void begin(Eigen::Index joints, double cycle_s) noexcept {
    last_.setZero(joints);
    kept_ = last_;
    cycle_s_ = cycle_s;
    left_s_ = 0;
    floats_ = false;
  }
  /// Each cycle: what is put out of what the law in force asks for, which is within the efforts, and so is that.
  [[nodiscard]] const JointVector& without_a_step(const JointVector& torque, bool floats, Bounds bounds) noexcept {
    if (floats != floats_) {
      kept_ = last_ - torque;
      left_s_ = fade_s;
      floats_ = floats;
    } else {
      left_s_ = std::max(0.0, left_s_ - cycle_s_);
    }
    last_ = torque;
    if (left_s_ <= 0) return last_;
    for (Eigen::Index i = 0; i < last_.size(); ++i) {
      const double effort = bounds[static_cast<std::size_t>(i)].effort;
      last_[i] = std::clamp(torque[i] + left_s_ / fade_s * kept_[i], -effort, effort);
    }
    return last_;
  }

 private:
  JointVector last_, kept_;
  double cycle_s_{0.001}, left_s_{0};
  bool floats_{false};
};

}  // namespace hirosco::robot_arm
