// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/setpoints.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

constexpr double no_way = 1e-9;
/// It goes back until it is so near to its end.
constexpr double near_enough = 1e-3;
/// As fast as that it may brake, of the accelerations.
constexpr double halting = 4;

}  // namespace

Setpoints::Setpoints(const robotics::Model& model, robotics::FrameId tip, Bounds bounds, double cycle_s,
                     const WayBack& way_back)
    : bounds_{bounds},
      cycle_s_{cycle_s},
      back_{way_back},
      tool_{model, tip},
      kinematics_{model, tip, {}},
      path_{bounds, cycle_s},
      line_{model, tip, bounds, cycle_s} {
  JointVector zeros;
  zeros.setZero(model.joint_count());
  jog_ = posture_ = met_ = end_ = zeros;
  begin(zeros);
}

void Setpoints::rest(const JointVector& position) noexcept {
  now_.position = position;
  come_to_rest();
}

void Setpoints::begin(const JointVector& position) noexcept {
  rest(position);
  trail_.clear();
  trail_.record(position);
}

void Setpoints::pass(const JointVector& position) noexcept {
  rest(position);
  trail_.record(position);
}

void Setpoints::come_to_rest() noexcept {
  kind_ = Kind::Rest;
  braking_ = false;
  tells_acceleration_ = true;
  urgency_ = 1;
  now_.velocity.setZero(now_.position.size());
  now_.acceleration.setZero(now_.position.size());
}

Result<> Setpoints::go(const JointVector& goal, double speed_share) noexcept {
  HIROSCO_TRY(path_.begin(now_.position, goal, speed_share, power_));
  kind_ = Kind::JointPath;
  braking_ = on_line_ = false;
  return ok();
}

Result<> Setpoints::go_straight(const robotics::Pose& goal, const Line::Speed& speed,
                                const PreferredPosture& preferred) noexcept {
  HIROSCO_TRY(line_.begin(goal, speed, now_.position, tool_, preferred));
  kind_ = Kind::Line;
  braking_ = false;
  on_line_ = true;
  return ok();
}

void Setpoints::jog(const JointVector& velocity) noexcept {
  kind_ = Kind::JointJog;
  braking_ = false;
  jog_ = velocity;
}

void Setpoints::jog(const Vector6& twist) noexcept {
  kind_ = Kind::TipJog;
  braking_ = false;
  twist_ = twist;
  posture_ = now_.position;
}

void Setpoints::halt(const JointVector& position, const JointVector& velocity) noexcept {
  now_.position = position;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    now_.velocity[i] = std::clamp(velocity[i], -bounds_[joint].motion.velocity, bounds_[joint].motion.velocity);
  }
  kind_ = Kind::JointJog;
  braking_ = true;
  tells_acceleration_ = true;
  urgency_ = halting;
}

void Setpoints::settle(const JointVector& position, const JointVector& velocity) noexcept {
  halt(position, velocity);
  now_.acceleration.setZero();
  tells_acceleration_ = false;
}

void Setpoints::retract(const JointVector& position, const JointVector& velocity, double distance) noexcept {
  halt(position, velocity);
  // It was pushed off its way: what lies ahead of it is not gone to.
  while (trail_.size() > 1 && apart(position, trail_.place(1)) <= apart(position, trail_.newest())) trail_.drop();
  met_ = end_ = position;
  places_back_ = 0;
  double gone = 0, length = 0;
  while (places_back_ < trail_.size() && gone < distance) {
    const JointVector& next = trail_.place(places_back_);
    length = apart(end_, next);
    const double share = gone + length > distance ? (distance - gone) / length : 1;
    if (share >= 1) ++places_back_;
    end_ += share * (next - end_);
    gone += share * length;
  }
  left_behind_ = places_back_ > 0 ? gone - apart(met_, trail_.newest()) : 0;
  retract_left_s_ = back_.longest_s;
  if (gone < near_enough) return;
  kind_ = Kind::Retract;
  braking_ = false;
}

void Setpoints::take(const Setpoint& next) noexcept {
  now_ = next;
  kind_ = Kind::Follow;
  braking_ = false;
}

void Setpoints::brake() noexcept {
  if (kind_ != Kind::Rest) braking_ = true;
  if (kind_ == Kind::Follow) kind_ = Kind::JointJog;  // nobody is followed any more
}

JointVector Setpoints::braked() const noexcept {
  if (kind_ == Kind::Rest) return now_.position;
  if (kind_ == Kind::Line) return line_.braked(now_.position);
  if (kind_ == Kind::JointPath) return path_.braked(braking_);
  JointVector there = now_.position;
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    const double most = bounds_[i].motion.acceleration;
    if (now_.velocity[joint] == 0) continue;
    const double speed = std::abs(now_.velocity[joint]) + most * cycle_s_;
    there[joint] += std::copysign(speed * cycle_s_ + speed * speed / (2 * most), now_.velocity[joint]);
  }
  return there;
}

const Setpoint& Setpoints::advance() noexcept {
  switch (kind_) {
    case Kind::Rest:
    case Kind::Follow: break;
    case Kind::JointPath:
      if (path_.advance(braking_, power_, now_)) come_to_rest();
      break;
    case Kind::Line: advance_line(); break;
    case Kind::JointJog: advance_jog(jog_); break;
    case Kind::TipJog: advance_jog(braking_ ? jog_ : tool_.rates(kinematics_, twist_, now_.position, posture_)); break;
    case Kind::Retract: advance_jog(way_back()); break;
  }
  if (kind_ != Kind::Rest && kind_ != Kind::Retract) trail_.record(now_.position);
  return now_;
}

std::optional<std::size_t> Setpoints::joint_in_the_way() const noexcept {
  const double margin = robotics::InverseKinematicsOptions{}.margin;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double left = now_.velocity[i] > 0   ? bounds_[joint].highest - now_.position[i]
                        : now_.velocity[i] < 0 ? now_.position[i] - bounds_[joint].lowest
                                               : HUGE_VAL;
    if (left < margin) return joint;
  }
  return std::nullopt;
}

void Setpoints::advance_line() noexcept {
  const LineMotion::Step step = line_.advance(now_, braking_, power_, tool_);
  if (step.rates) follow(*step.rates);
  if (step.ends) come_to_rest();
}

/// Towards the velocities that are wanted, within acceleration, and so that each can be braked away before its range ends.
void Setpoints::advance_jog(const JointVector& wanted) noexcept {
  JointVector velocity = now_.velocity;
  bool moves = false;
  const double share = power_.share(wanted);
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const JointBounds& its = bounds_[joint];
    const double most = its.motion.velocity, step = urgency_ * its.motion.acceleration * cycle_s_;
    const double left = std::max(0.0, its.highest - now_.position[i]),
                 right = std::max(0.0, now_.position[i] - its.lowest);
    const double up = std::min(most, std::sqrt(2 * 0.8 * its.motion.acceleration * left));
    const double down = std::min(most, std::sqrt(2 * 0.8 * its.motion.acceleration * right));
    const double goal = braking_ ? 0.0 : std::clamp(share * wanted[i], -down, up);
    velocity[i] += std::clamp(goal - velocity[i], -step, step);
    moves = moves || velocity[i] != 0;
  }
  follow(velocity);
  if (braking_ && !moves) come_to_rest();
}

/// Towards the place before, so that it can brake where the way back ends.
JointVector Setpoints::way_back() noexcept {
  while (places_back_ > 0 && apart(now_.position, trail_.newest()) < Trail::spacing) {
    const JointVector reached = trail_.newest();
    trail_.drop();
    --places_back_;
    left_behind_ -= apart(reached, places_back_ > 0 ? trail_.newest() : end_);
  }
  const JointVector way = (places_back_ > 0 ? trail_.newest() : end_) - now_.position;
  const double next = apart(way, JointVector::Zero(way.size()));
  const double left = next + (places_back_ > 0 ? std::max(0.0, left_behind_) : 0.0);
  retract_left_s_ -= cycle_s_;
  if (left < near_enough || retract_left_s_ <= 0) braking_ = true;
  if (braking_ || next < no_way) return jog_;
  double rate = HUGE_VAL;
  bool turned = true;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double share = std::abs(way[i]) / next;
    if (share <= no_way) continue;
    const auto& its = bounds_[joint].motion;
    rate = std::min({rate, back_.speed_share * its.velocity / share, std::sqrt(its.acceleration / share * left)});
    turned = turned && now_.velocity[i] * way[i] >= 0;
  }
  if (turned) urgency_ = 1;
  return way * (rate / next);
}

void Setpoints::follow(const JointVector& velocity) noexcept {
  if (tells_acceleration_) now_.acceleration = (velocity - now_.velocity) / cycle_s_;
  now_.velocity = velocity;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double next = now_.position[i] + velocity[i] * cycle_s_;
    now_.position[i] = std::clamp(next, bounds_[joint].lowest, bounds_[joint].highest);
  }
}

}  // namespace hirosco::robot_arm
