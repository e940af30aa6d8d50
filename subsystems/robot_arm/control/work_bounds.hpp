// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/tool_lever.hpp"

/// With which force the tool presses, and how much work joints and tool do: bounded where torques are made, watched where they are measured.
namespace hirosco::robot_arm {

struct WorkLimits {
  double force_n{HUGE_VAL};  ///< at the tool
  double power_w{HUGE_VAL};  ///< of all joints, what they give; who is braked takes, which is neither added nor set off
  double tool_power_w{HUGE_VAL};  ///< of the tool's force along its way
};

/// No more than this share of a limit is commanded: what is measured is never quite what was meant, and is stopped beyond the whole.
inline constexpr double commanded_share = 0.9;

/// What of a torque carries; the rest of it presses.
struct Carried {
  JointVector known;  ///< holds the arm up, moves it as the model says and keeps it within its ranges
  /// For what the model does not know: a load, or somebody on whom it pressed, and nobody can tell which. It stays, and counts.
  JointVector learnt;
};

/// Of `torque` what keeps within the commanded share of the limits. What is known to carry is never taken back. What presses is: as a whole for force and
/// power of the tool, so far that it keeps them together with what was learnt, which is taken back itself only where it is beyond them alone; and
/// for the power of joints of those that it drives: one that is braked gives nothing.
[[nodiscard]] JointVector within_work(const JointVector& torque, const Carried& carried, const JointVector& speed,
                                      const ToolLever& lever, const WorkLimits& limits) noexcept;

}  // namespace hirosco::robot_arm
