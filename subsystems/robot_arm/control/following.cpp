// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/following.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// How fast what is left closes when it is little, and no more of it in a cycle than so.
constexpr double closing_per_s = 20, closing_share = 0.25;
/// Of the accelerations, before where it is to stand: what is left of them is for the cycle that passes until the next look.
constexpr double stopping_share = 0.8;

}  // namespace

Following::Following(Bounds bounds, double cycle_s) noexcept
    : bounds_{bounds}, cycle_s_{cycle_s}, closing_per_s_{std::min(closing_per_s, closing_share / cycle_s)} {
  double longest_s = 0;
  for (const JointBounds& its : bounds) longest_s = std::max(longest_s, 2 * its.motion.acceleration / its.motion.jerk);
  // Less than a cycle of what rounding makes of a whole number of them is none.
  const double cycles = std::ceil(longest_s / cycle_s - 1e-6);
  cycles_ = static_cast<std::size_t>(std::clamp(cycles, 1.0, double{most_cycles}));
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto& its = bounds[joint].motion;
    accelerations_[joint] = std::min(its.acceleration, its.jerk * static_cast<double>(cycles_) * cycle_s / 2);
  }
  begin(JointVector::Zero(static_cast<Eigen::Index>(bounds.size())));
}

void Following::begin(const JointVector& position) noexcept {
  const JointVector zeros = JointVector::Zero(position.size());
  place_ = position;
  velocity_ = sum_ = since_turn_ = zeros;
  for (std::size_t i = 0; i < cycles_; ++i) velocities_[i] = zeros;
  next_ = 0;
  still_cycles_ = cycles_;
  now_ = {position, zeros, zeros};
}

/// With which it may go there and stand: slower the nearer it is, and never more braked than its acceleration.
double Following::approach(double distance, double acceleration) const noexcept {
  const double braked = stopping_share * acceleration;
  const double near = braked / (closing_per_s_ * closing_per_s_);
  return distance <= near ? closing_per_s_ * distance : std::sqrt(2 * braked * (distance - near / 2));
}

const Setpoint& Following::go_to(const JointVector& position, const JointVector& velocity) noexcept {
  JointVector wanted = velocity;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double left = position[i] - place_[i];
    wanted[i] += std::copysign(approach(std::abs(left), accelerations_[joint]), left);
  }
  return step(wanted);
}

const Setpoint& Following::go_with(const JointVector& velocity) noexcept { return step(velocity); }

const Setpoint& Following::slow_down() noexcept { return step(JointVector::Zero(place_.size())); }

/// Within accelerations. While others still slow down, nobody gets faster than their power leaves.
void Following::change_velocity(const JointVector& goal) noexcept {
  const double pace = power_.share(goal);
  JointVector next = velocity_;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double change = accelerations_[joint] * cycle_s_;
    next[i] += std::clamp(pace * goal[i] - velocity_[i], -change, change);
  }
  const double share = power_.quickening_share(velocity_, next);
  for (Eigen::Index i = 0; i < next.size(); ++i)
    if (share < 1 && std::abs(next[i]) > std::abs(velocity_[i]))
      next[i] = velocity_[i] + share * (next[i] - velocity_[i]);
  velocity_ = next;
}

const Setpoint& Following::step(const JointVector& wanted) noexcept {
  JointVector goal = wanted;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const JointBounds& its = bounds_[joint];
    const double most = its.motion.velocity;
    const double up = std::min(most, approach(std::max(0.0, its.highest - place_[i]), accelerations_[joint]));
    const double down = std::min(most, approach(std::max(0.0, place_[i] - its.lowest), accelerations_[joint]));
    goal[i] = std::clamp(wanted[i], -down, up);
  }
  change_velocity(goal);
  place_ += velocity_ * cycle_s_;
  const bool still = velocity_.isZero(0);
  sum_ += velocity_ - velocities_[next_];
  since_turn_ += velocity_;
  velocities_[next_] = velocity_;
  if (++next_ == cycles_) {
    next_ = 0;
    sum_ = since_turn_;
    since_turn_.setZero();
  }
  still_cycles_ = still ? std::min(still_cycles_ + 1, cycles_) : 0;
  const JointVector mean = sum_ / static_cast<double>(cycles_);
  now_.acceleration = (mean - now_.velocity) / cycle_s_;
  now_.velocity = mean;
  now_.position += mean * cycle_s_;
  if (at_rest()) {
    now_.position = place_;
    now_.velocity.setZero();
  }
  return now_;
}

}  // namespace hirosco::robot_arm
