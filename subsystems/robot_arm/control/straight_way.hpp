// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// The straight way of all joints from one posture to another, looked at before it is gone (docs/adr/0209): evenly spread postures, one in a cycle, so few that nobody waits for them for
/// longer than a tenth of a second. So not everything that is in the way is seen, and what is not stops the motion as it comes to it.
/// Realtime: bounded, no allocation. Thread: any, one at a time.
class StraightWay {
 public:
  static constexpr std::size_t most = 64;
  static constexpr double longest_s = 0.1;
  /// No nearer to each other than this, of the joint that has farthest to go, rad or m.
  static constexpr double spacing = 0.02;

  void begin(const JointVector& from, const JointVector& goal, double cycle_s) noexcept;
  [[nodiscard]] const JointVector& from() const noexcept { return from_; }
  [[nodiscard]] const JointVector& goal() const noexcept { return goal_; }

  // --- once in each cycle -------------------------------------------------------------------------------------------------
  /// To the next posture, the goal in the end; false: all of them were looked at.
  [[nodiscard]] bool step() noexcept;
  /// Who is too near there?
  [[nodiscard]] JointVector posture() const noexcept { return from_ + share() * (goal_ - from_); }
  /// How much of the way is before that: 0 to 1.
  [[nodiscard]] double share() const noexcept { return static_cast<double>(step_) / static_cast<double>(steps_); }

 private:
  JointVector from_, goal_;
  std::size_t steps_{1}, step_{0};
};

}  // namespace hirosco::robot_arm
