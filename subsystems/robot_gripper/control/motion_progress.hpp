// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "subsystems/robot_gripper/control/grip.hpp"
#include "subsystems/robot_gripper/control/opening.hpp"

namespace hirosco::robot_gripper {

/// How far a motion is that somebody waits for, one at a time: to a width, or a grip. It judges; what follows is others' to do.
class MotionProgress {
 public:
  enum class End : std::uint8_t {
    None,  ///< not yet
    Reached,
    NotReached,  ///< its path has ended, and it is not there
    Obstructed,
    Held,  ///< something is pressed on as it is to be
    NothingMet,
    ForceNotReached,  ///< it presses on something, not as it is to
  };
  /// What a cycle has brought, in the order in which it is told.
  struct News {
    bool step{false};  ///< half-way, or something is met: once in a motion
    End end{End::None};
  };
  /// Of a motion to a width, m.
  struct Limits {
    double behind_m{0.003};  ///< its path; farther for 50 ms: something is in the way
    double off_goal_m{0.0005};
  };

  /// `cycle_s`: between calls of follow(), s.
  void begin_path(double goal_m, double cycle_s) noexcept;
  void begin_grip(double cycle_s) noexcept;
  /// m, of the newest path.
  [[nodiscard]] double goal_m() const noexcept { return goal_m_; }

  /// A cycle of a path: `width_m` is measured.
  [[nodiscard]] News follow(const Opening& opening, double width_m, const Limits& limits) noexcept;
  /// A cycle of a grip: `met` is met() of it.
  [[nodiscard]] News follow(const Grip& grip, End met) noexcept;
  /// What has come of pressing, whoever waits for it: Held, NothingMet, or None. At `empty_m` there is nothing between the fingers.
  [[nodiscard]] static End met(const Grip& grip, double width_m, double empty_m) noexcept;

 private:
  double cycle_s_{0.001};
  double goal_m_{0};
  double waited_s_{0};  ///< behind the end of a path, or pressing
  double settled_s_{0};  ///< at the goal
  double behind_s_{0};  ///< farther behind than it may be
  bool reported_{false};
};

}  // namespace hirosco::robot_gripper
