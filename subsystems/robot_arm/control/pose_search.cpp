// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/pose_search.hpp"

#include <algorithm>

namespace hirosco::robot_arm {
namespace {

constexpr int most_steps = 50;
/// Rad and m: so near is there, too, for an arm of fewer than 6 joints, whose pose nobody writes down exactly.
constexpr double near_enough_off = 2e-4, nearly_off = 0.01;
constexpr double at_end = 1e-3;

}  // namespace

void PoseSearch::begin(const robotics::Pose& tip, const JointVector& from, const PreferredPosture& preferred) noexcept {
  tip_ = tip;
  preferred_ = preferred;
  from_preferred_ = preferred.counts();
  from_ = from;
  posture_ = from_preferred_ ? preferred.joints : from;
  steps_ = 0;
}

/// First from the posture that is preferred, and nobody asks where the arm stands: so the answer is the goal's alone.
PoseSearch::Found PoseSearch::step() noexcept {
  if (found_one()) return Found::Posture;
  if (++steps_ < most_steps) return Found::NotYet;
  if (kinematics_.left(tip_, posture_).cwiseAbs().maxCoeff() <= near_enough_off) return Found::Posture;
  if (!from_preferred_) return Found::Nothing;
  from_preferred_ = false;
  posture_ = from_;
  steps_ = 0;
  return Found::NotYet;
}

/// Who has no joint to spare is drawn nowhere: he begins at the posture, and where a search is damped, as that of fewer than 6 joints always is, a draw would keep him off the pose.
bool PoseSearch::found_one() noexcept {
  if (preferred_.draws()) return drawn_.solve(tip_, preferred_.joints, posture_).has_value();
  const JointVector to = preferred_.counts() || from_.size() < tool_directions ? posture_ : from_;
  return kinematics_.solve(tip_, to, posture_).has_value();
}

bool PoseSearch::singular() noexcept {
  return kinematics_.smallest_singular_value(posture_) < a_little_at_a_time.singular;
}

bool PoseSearch::nearly() noexcept { return kinematics_.left(tip_, posture_).cwiseAbs().maxCoeff() <= nearly_off; }

std::optional<std::size_t> PoseSearch::joint_at_its_end() const noexcept { return at_its_end(bounds_, posture_); }

std::optional<std::size_t> at_its_end(Bounds bounds, const JointVector& posture) noexcept {
  std::optional<std::size_t> nearest;
  double least = at_end;
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const double its = posture[static_cast<Eigen::Index>(joint)];
    const double left = std::min(bounds[joint].highest - its, its - bounds[joint].lowest);
    if (left > least) continue;
    least = left;
    nearest = joint;
  }
  return nearest;
}

}  // namespace hirosco::robot_arm
