// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/line_motion.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// With which a setpoint that is beside its line comes back to it, 1/s.
constexpr double back_to_line_per_s = 50;
/// Behind the end of a line: who is not on it by then, within the last digits, stands as near as it is.
constexpr double longest_settling_s = 0.5;
/// It goes no slower for what its survey has not seen.
constexpr double slowest_pace = 0.01;
constexpr double no_rate = 1e-9;

}  // namespace

LineMotion::LineMotion(const robotics::Model& model, robotics::FrameId tip, Bounds bounds, double cycle_s)
    : bounds_{bounds}, cycle_s_{cycle_s}, line_{model, tip, bounds} {
  posture_.setZero(model.joint_count());
}

Result<> LineMotion::begin(const robotics::Pose& goal, const Line::Speed& speed, const JointVector& posture,
                           ToolKinematics& tool, const PreferredPosture& preferred) noexcept {
  HIROSCO_TRY(line_.plan(tool.pose(posture), goal, tool.in_tip(), speed, posture));
  line_.prefer(preferred);
  duration_s_ = line_.path().duration_s();
  off_m_ = 0;
  on_ = {};
  line_.path().at(0, sample_);
  posture_ = preferred.draws() ? preferred.joints : posture;
  drawn_per_s_ = preferred.draws() ? preferred.gain_per_s : 1;
  return ok();
}

JointVector LineMotion::braked(const JointVector& position) const noexcept {
  if (line_.found() != Line::Found::Way) return position;
  const double pace = std::min(line_.pace(on_.at_s), on_.pace + line_.change_per_s(on_.at_s) * cycle_s_);
  const double rest_s = rest_on(line_, bounds_, {on_.at_s + pace * cycle_s_, pace});
  return position + line_.posture_at(rest_s) - line_.posture_at(on_.at_s);
}

LineMotion::Step LineMotion::survey(bool braking) noexcept {
  if (!braking) line_.survey();
  if (line_.found() == Line::Found::Way) {
    on_.pace = line_.pace(0);
    duration_s_ = line_.duration_s();
  }
  return {.ends = braking || line_.found() == Line::Found::Nothing};
}

/// `onward`: what the joints do at full pace, besides what brings them back to the line. Braked, or for its power, the pace is the least that their accelerations permit.
void LineMotion::keep_pace(const JointVector& onward, const JointVector& back, const JointVector& velocity,
                           bool braking, const PowerPace& power) noexcept {
  const double most = line_.pace(on_.at_s), share = power.share(onward);
  if (!braking && share >= on_.pace) {
    on_.pace = std::min({most, share, on_.pace + line_.change_per_s(on_.at_s) * cycle_s_});
    return;
  }
  // Who brakes has his time for it; who is to give less power gives less at once.
  double least = braking ? std::min(share, std::max(0.0, on_.pace - cycle_s_ / Line::ramp_s)) : share;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    if (std::abs(onward[i]) < no_rate) continue;
    const double step = braking_share * bounds_[joint].motion.acceleration * cycle_s_;
    const double kept = velocity[i] - back[i];
    least = std::max(least, std::min((kept - step) / onward[i], (kept + step) / onward[i]));
  }
  on_.pace = std::min({least, on_.pace, most});
}

/// The survey has looked at some places; what lies between them keeps velocities and accelerations as well, and goes on slower.
void LineMotion::keep_limits(const JointVector& velocity, JointVector& rates) noexcept {
  double speed_share = 1, change_share = 1;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double most = bounds_[joint].motion.velocity;
    if (std::abs(rates[i]) > most) speed_share = std::min(speed_share, most / std::abs(rates[i]));
  }
  rates *= speed_share;
  const JointVector change = rates - velocity;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const double its = std::abs(change[static_cast<Eigen::Index>(joint)]);
    const double most = bounds_[joint].motion.acceleration * cycle_s_;
    if (its > most) change_share = std::min(change_share, most / its);
  }
  rates = velocity + change_share * change;
  if (speed_share < 1 || change_share < 1)
    on_.pace = std::max(std::min(on_.pace, slowest_pace), on_.pace - 2 * line_.change_per_s(on_.at_s) * cycle_s_);
}

LineMotion::Step LineMotion::advance(const Setpoint& now, bool braking, const PowerPace& power,
                                     ToolKinematics& tool) noexcept {
  if (on_.at_s <= 0 && line_.found() != Line::Found::Way) return survey(braking);
  on_.at_s += on_.pace * cycle_s_;
  line_.path().at(on_.at_s, sample_);
  const double share = sample_.position[0], rate = sample_.velocity[0];
  const robotics::Pose here = tool.pose(now.position), wanted = line_.at(share);
  const Vector3 beside = wanted.position - here.position;
  off_m_ = beside.norm();
  Vector6 twist;
  twist.head<3>() = back_to_line_per_s * rotation_vector(wanted.rotation * here.rotation.transpose());
  twist.tail<3>() = back_to_line_per_s * beside;
  const JointVector back = tool.rates(line_.kinematics(), twist, now.position, now.position);
  // Joints that the tool leaves free are drawn while it goes, and stand when it does.
  const JointVector drawn = now.position + drawn_per_s_ * rate / line_.rate() * (posture_ - now.position);
  const JointVector onward = tool.rates(line_.kinematics(), rate * line_.twist(), now.position, drawn);
  keep_pace(onward, back, now.velocity, braking, power);
  JointVector rates = on_.pace * onward + back;
  keep_limits(now.velocity, rates);
  const bool there = beside.norm() < 1e-7 && rates.cwiseAbs().maxCoeff() < 1e-5;
  const double behind_s = on_.at_s - line_.path().duration_s();
  const bool ends = (braking && on_.pace <= 0) || (behind_s >= 0 && (there || behind_s >= longest_settling_s));
  return {.rates = rates, .ends = ends};
}

}  // namespace hirosco::robot_arm
