// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/arrival.hpp"

#include <Eigen/Geometry>

namespace hirosco::robot_arm {
namespace {

/// So long a goal has to be measured before it counts as reached, and at most so long after the end of the path.
constexpr double settled_enough_s = 0.02;
constexpr double patience_s = 3;
/// Of the end of a path, where the tool has to be measured.
constexpr double most_off_end_m = 0.001, most_turned_off_rad = 0.001;

}  // namespace

bool Arrival::tell_half(bool behind) noexcept {
  if (to_ != To::Goal || half_told_ || !behind) return false;
  return half_told_ = true;
}

void Arrival::end_path(const robotics::Pose& tool) noexcept {
  path_ended_ = true;
  if (to_ != To::Goal) return;
  // What an arm without every orientation lacks of its goal's was borne when its line was judged.
  if (tool_to_m_) turned_to_ = tool.rotation;
  else tool_to_m_ = tool.position;
}

bool Arrival::there(const JointVector& left, double tolerance, const robotics::Pose& tool) const noexcept {
  // A long arm's joints are all there, and its tool is not; what each of them is turned off adds up.
  const auto turned_off_rad = [&] {
    return robotics::Quaternion{tool.rotation}.angularDistance(robotics::Quaternion{*turned_to_});
  };
  const bool at_end = !tool_to_m_ || (tool.position - *tool_to_m_).norm() <= most_off_end_m;
  const bool as_there = !turned_to_ || turned_off_rad() <= most_turned_off_rad;
  return at_end && as_there && left.cwiseAbs().maxCoeff() <= tolerance;
}

void Arrival::wait(bool there, double cycle_s) noexcept {
  settled_s_ = there ? settled_s_ + cycle_s : 0;
  waited_s_ += cycle_s;
}

bool Arrival::settled() const noexcept { return settled_s_ >= settled_enough_s; }

bool Arrival::overdue() const noexcept { return waited_s_ > patience_s; }

}  // namespace hirosco::robot_arm
