// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_beforehand.hpp"

#include <cmath>

#include "subsystems/robot_arm/floating/floating_ahead.hpp"

namespace hirosco::robot_arm {

void FloatingBeforehand::begin(double cycle_s) {
  cycle_s_ = cycle_s;
  tool_.emplace(parts_.known.model(), parts_.known.tip());
  end();
}

std::optional<FloatingReason> FloatingBeforehand::judge(const JointVector& from, const JointVector& goal,
                                                        double duration_s) noexcept {
  const Bounds bounds = parts_.known.bounds();
  const JointVector& here = parts_.drives.measured().position;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    if (!(goal[joint] >= bounds[i].lowest && goal[joint] <= bounds[i].highest))
      return FloatingReason{FloatingTrouble::out_of_range, "joint", static_cast<std::int64_t>(i + 1)};
    const double fastest = fastest_of_course * std::abs(goal[joint] - from[joint]) / duration_s;
    if (!(fastest <= bounds[i].motion.velocity))
      return FloatingReason{FloatingTrouble::too_fast, "joint", static_cast<std::int64_t>(i + 1)};
  }
  if (const auto there = parts_.obstacles.nearer(here, goal); there.distance_m != HUGE_VAL)
    return FloatingReason{FloatingTrouble::too_near, there.names, millimetres(there.distance_m)};
  joints_.begin(from, goal, cycle_s_);
  of_ = Of::AllJoints;
  return std::nullopt;
}

void FloatingBeforehand::judge(const ToolWay::Plan& plan) noexcept {
  ToolWay::Plan its = plan;
  its.cycle_s = cycle_s_;
  tool_->begin(its);
  of_ = Of::Tool;
}

FloatingBeforehand::Found FloatingBeforehand::step() noexcept {
  const bool joints = of_joints();
  if (!(joints ? joints_.step() : tool_->step(parts_.known.bounds()))) {
    end();
    return joints ? Found::JointsMayGo : Found::ToolMayGo;
  }
  const auto ahead = parts_.obstacles.near_on_way(parts_.drives.measured().position,
                                                  joints ? joints_.posture() : tool_->posture(), shakes_m);
  if (!ahead) return Found::NotYet;
  near_ = *ahead;
  return Found::Blocked;
}

}  // namespace hirosco::robot_arm
