// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/path_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hirosco::robot_arm {

Result<robotics::PointToPoint> PathMotion::plan(const JointVector& from, const JointVector& goal,
                                                double speed_share) const noexcept {
  std::array<robotics::MotionLimits, max_joints> limits;
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    limits[i] = bounds_[i].motion;
    limits[i].velocity *= speed_share;
  }
  return robotics::PointToPoint::plan_straight(from, goal, std::span{limits}.first(bounds_.size()));
}

double PathMotion::with_power_s(const robotics::PointToPoint& path, const PowerPace& power) noexcept {
  robotics::PointToPoint::Sample sample;
  path.at(path.duration_s() / 2, sample);
  return path.duration_s() / power.share(sample.velocity);
}

double PathMotion::foreseen_s(const JointVector& from, const JointVector& goal, double speed_share,
                              const PowerPace& power) const noexcept {
  const auto planned = plan(from, goal, speed_share);
  return planned ? with_power_s(*planned, power) : HUGE_VAL;
}

Result<> PathMotion::begin(const JointVector& from, const JointVector& goal, double speed_share,
                           const PowerPace& power) noexcept {
  HIROSCO_TRY_LET(path_, plan(from, goal, speed_share));
  duration_s_ = with_power_s(path_, power);
  path_.at(0, sample_);
  on_ = {};
  return ok();
}

/// How much faster the time of a path may go, 1/s: by what is left of the accelerations of joints that are accelerated on it already.
double PathMotion::quickening() const noexcept {
  double most = 1 / cycle_s_;
  robotics::PointToPoint::Sample sample;
  for (const double ahead_s : {0.0, on_.pace * cycle_s_}) {
    path_.at(on_.at_s + ahead_s, sample);
    for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
      const auto i = static_cast<Eigen::Index>(joint);
      const double speed = std::abs(sample.velocity[i]);
      const double taken = sample.velocity[i] * sample.acceleration[i] > 0 ? std::abs(sample.acceleration[i]) : 0;
      const double left = braking_share * bounds_[joint].motion.acceleration - on_.pace * on_.pace * taken;
      if (speed > 0) most = std::min(most, std::max(0.0, left) / speed);
    }
  }
  return most;
}

bool PathMotion::advance(bool braking, const PowerPace& power, Setpoint& setpoint) noexcept {
  const double most = braking ? 0.0 : power.share(sample_.velocity);
  double slower = 0;
  if (on_.pace > most) slower = std::min(slowing(path_, bounds_, on_, cycle_s_), (on_.pace - most) / cycle_s_);
  if (on_.pace < most) slower = -std::min(quickening(), (most - on_.pace) / cycle_s_);
  on_.pace = std::max(0.0, on_.pace - slower * cycle_s_);
  on_.at_s += on_.pace * cycle_s_;
  path_.at(on_.at_s, sample_);
  setpoint.position = sample_.position;
  setpoint.velocity = on_.pace * sample_.velocity;
  setpoint.acceleration = on_.pace * on_.pace * sample_.acceleration - slower * sample_.velocity;
  return on_.at_s >= path_.duration_s() || on_.pace <= 0;
}

JointVector PathMotion::braked(bool braking) const noexcept {
  robotics::PointToPoint::Sample sample;
  const double pace = std::min(1.0, on_.pace + (braking ? 0.0 : quickening() * cycle_s_));
  path_.at(rest_on(path_, bounds_, {on_.at_s + pace * cycle_s_, pace}, cycle_s_), sample);
  return sample.position;
}

}  // namespace hirosco::robot_arm
