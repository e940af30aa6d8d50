// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/tool_way.hpp"

#include "subsystems/robot_arm/floating/range_ends.hpp"

namespace hirosco::robot_arm {

void ToolWay::begin(const Plan& plan) noexcept {
  plan_ = plan;
  posture_ = plan.position;
  base_.stand_still();
  base_.take(plan.base.position, robotics::Quaternion{plan.base.rotation});
  taken_ = 0;
}

bool ToolWay::step(Bounds bounds) noexcept {
  if (taken_ >= steps) return false;
  ++taken_;
  if (go_on(bounds)) return true;
  taken_ = steps;
  return false;
}

/// As the cycle judges who goes: a joint before the end of its range ends a motion, and so does a base that could not be left unturned.
bool ToolWay::go_on(Bounds bounds) noexcept {
  if (!model_.update({base_.orientation().toRotationMatrix(), base_.position_m()}, posture_)) return false;
  if (plan_.law == ToolLaw::AttitudeHold && model_.conditioning() < least_conditioning) return false;
  const double step_s = plan_.duration_s / steps;
  const JointVector its = rates(bounds, step_s);
  const JointVector way = step_s * its;
  const double per_s = followed_with(model_.heavier(), plan_.cycle_s);
  if (end_ahead(posture_, its, bounds, per_s) || comes_to_end(way, bounds)) return false;
  if (plan_.law != ToolLaw::FixedBase) base_.go_on(model_.base() * way, 1);
  posture_ += way;
  return true;
}

/// All that is left to the next place of the course, in the time of a step: who is behind a little is not behind at the next one.
JointVector ToolWay::rates(Bounds bounds, double step_s) const noexcept {
  ToolGoal goal{plan_.tool, Vector3::Zero()};
  const Course at = course(taken_ * step_s, plan_.duration_s);
  goal.pose.position += at.share * plan_.offset_m;
  JointVector drawn;
  const bool draws = plan_.preferred.draws();
  if (draws) drawn = step_s * drawn_to(plan_.preferred, posture_, bounds, pace(at, plan_.duration_s));
  JointVector rates = tool_rates(plan_.law, model_, bounds, goal, base_.orientation().toRotationMatrix(),
                                 plan_.base_kept, draws ? &drawn : nullptr);
  rates *= 1 / step_s;  // the law closes in a second what is left
  slow_down(rates, bounds);
  return rates;
}

/// A step may be longer than what is left before an end that the law keeps off cycle by cycle.
bool ToolWay::comes_to_end(const JointVector& way, Bounds bounds) const noexcept {
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double next = posture_[i] + way[i];
    if (way[i] > 0 && next > bounds[joint].highest - kept_from_end) return true;
    if (way[i] < 0 && next < bounds[joint].lowest + kept_from_end) return true;
  }
  return false;
}

}  // namespace hirosco::robot_arm
