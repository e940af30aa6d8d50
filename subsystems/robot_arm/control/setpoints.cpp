// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/setpoints.hpp"

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/control/braking.hpp"

namespace hirosco::robot_arm {
namespace {

/// With which a setpoint that is beside its line comes back to it, 1/s.
constexpr double back_to_line_per_s = 50;
/// Behind the end of a line: who is not on it by then, within the last digits, stands as near as it is.
constexpr double longest_settling_s = 0.5;
/// It goes no slower for what its survey has not seen.
constexpr double slowest_pace = 0.01;
constexpr double no_way = 1e-9;
/// It goes back with this share of the velocities, until it is so near to its end, and no longer than so.
constexpr double retract_share = 0.25;
constexpr double near_enough = 1e-3;
constexpr double longest_retract_s = 10;
/// As fast as that it may brake, of the accelerations.
constexpr double halting = 4;

}  // namespace

Setpoints::Setpoints(const robotics::Model& model, robotics::FrameId tip, Bounds bounds, double cycle_s)
    : tip_{tip},
      bounds_{bounds},
      cycle_s_{cycle_s},
      dynamics_{model, robotics::Base::Fixed},
      kinematics_{model, tip, {}},
      line_{model, tip, bounds} {
  JointVector zeros;
  zeros.setZero(model.joint_count());
  jog_ = posture_ = met_ = end_ = zeros;
  state_.qd = zeros;
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

void Setpoints::come_to_rest() noexcept {
  kind_ = Kind::Rest;
  braking_ = false;
  tells_acceleration_ = true;
  urgency_ = 1;
  off_line_m_ = 0;
  now_.velocity.setZero(now_.position.size());
  now_.acceleration.setZero(now_.position.size());
}

Result<robotics::PointToPoint> Setpoints::plan(const JointVector& from, const JointVector& goal,
                                               double speed_share) const noexcept {
  std::array<robotics::MotionLimits, max_joints> limits;
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    limits[i] = bounds_[i].motion;
    limits[i].velocity *= speed_share;
  }
  return robotics::PointToPoint::plan_straight(from, goal, std::span{limits}.first(bounds_.size()));
}

double Setpoints::with_power_s(const robotics::PointToPoint& path) const noexcept {
  robotics::PointToPoint::Sample sample;
  path.at(path.duration_s() / 2, sample);
  return path.duration_s() / power_.share(sample.velocity);
}

double Setpoints::duration_s(const JointVector& from, const JointVector& goal, double speed_share) const noexcept {
  const auto planned = plan(from, goal, speed_share);
  return planned ? with_power_s(*planned) : HUGE_VAL;
}

Result<> Setpoints::go(const JointVector& goal, double speed_share) noexcept {
  HIROSCO_TRY_LET(path_, plan(now_.position, goal, speed_share));
  duration_s_ = with_power_s(path_);
  path_.at(0, sample_);
  kind_ = Kind::JointPath;
  braking_ = false;
  path_s_ = 0;
  pace_ = 1;
  return ok();
}

Result<> Setpoints::go_straight(const robotics::Pose& goal, const Line::Speed& speed) noexcept {
  HIROSCO_TRY(line_.plan(tool(), goal, tool_, speed, now_.position));
  path_ = line_.path();
  duration_s_ = path_.duration_s();
  kind_ = Kind::Line;
  braking_ = false;
  path_s_ = 0;
  pace_ = 1;
  path_.at(0, sample_);
  posture_ = now_.position;
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
  off_line_m_ = 0;
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
  retract_left_s_ = longest_retract_s;
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

double Setpoints::progress() const noexcept {
  return path_.duration_s() > 0 ? std::clamp(path_s_ / path_.duration_s(), 0.0, 1.0) : 1.0;
}

robotics::Pose Setpoints::tool() noexcept {
  state_.q = now_.position;
  dynamics_.update(state_);
  return dynamics_.frame_pose(tip_) * tool_;
}

JointVector Setpoints::braked() const noexcept {
  if (kind_ == Kind::Rest) return now_.position;
  robotics::PointToPoint::Sample sample;
  if (kind_ == Kind::Line) {
    if (line_.found() != Line::Found::Way) return now_.position;
    const double pace = std::min(line_.pace(path_s_), pace_ + line_.change_per_s(path_s_) * cycle_s_);
    const double rest_s = rest_on(line_, bounds_, {path_s_ + pace * cycle_s_, pace});
    return now_.position + line_.posture_at(rest_s) - line_.posture_at(path_s_);
  }
  if (kind_ == Kind::JointPath) {
    const double pace = std::min(1.0, pace_ + (braking_ ? 0.0 : quickening() * cycle_s_));
    path_.at(rest_on(path_, bounds_, {path_s_ + pace * cycle_s_, pace}, cycle_s_), sample);
    return sample.position;
  }
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
    case Kind::JointPath: advance_path(); break;
    case Kind::Line: advance_line(); break;
    case Kind::JointJog: advance_jog(jog_); break;
    case Kind::TipJog: advance_jog(braking_ ? jog_ : tip_rates(kinematics_, twist_, posture_)); break;
    case Kind::Retract: advance_jog(way_back()); break;
  }
  if (kind_ != Kind::Rest && kind_ != Kind::Retract) trail_.record(now_.position);
  return now_;
}

/// How much faster the time of a path may go, 1/s: by what is left of the accelerations of joints that are accelerated on it already.
double Setpoints::quickening() const noexcept {
  double most = 1 / cycle_s_;
  robotics::PointToPoint::Sample sample;
  for (const double ahead_s : {0.0, pace_ * cycle_s_}) {
    path_.at(path_s_ + ahead_s, sample);
    for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
      const auto i = static_cast<Eigen::Index>(joint);
      const double speed = std::abs(sample.velocity[i]);
      const double taken = sample.velocity[i] * sample.acceleration[i] > 0 ? std::abs(sample.acceleration[i]) : 0;
      const double left = braking_share * bounds_[joint].motion.acceleration - pace_ * pace_ * taken;
      if (speed > 0) most = std::min(most, std::max(0.0, left) / speed);
    }
  }
  return most;
}

/// Braked, or for its power, the arm stays on its path: its time goes slower, as fast as the joints' accelerations permit.
void Setpoints::advance_path() noexcept {
  const double most = braking_ ? 0.0 : power_.share(sample_.velocity);
  double slower = 0;
  if (pace_ > most) slower = std::min(slowing(path_, bounds_, {path_s_, pace_}, cycle_s_), (pace_ - most) / cycle_s_);
  if (pace_ < most) slower = -std::min(quickening(), (most - pace_) / cycle_s_);
  pace_ = std::max(0.0, pace_ - slower * cycle_s_);
  path_s_ += pace_ * cycle_s_;
  path_.at(path_s_, sample_);
  now_.position = sample_.position;
  now_.velocity = pace_ * sample_.velocity;
  now_.acceleration = pace_ * pace_ * sample_.acceleration - slower * sample_.velocity;
  if (path_s_ >= path_.duration_s() || pace_ <= 0) come_to_rest();
}

JointVector Setpoints::tip_rates(const robotics::InverseKinematics& kinematics, const Vector6& twist,
                                 const JointVector& posture) noexcept {
  state_.q = now_.position;
  dynamics_.update(state_);
  // The same motion, told of the tip's origin.
  const Vector3 lever = dynamics_.frame_pose(tip_).rotation * tool_.position;
  Vector6 of_tip = twist;
  const Vector3 turning = twist.head<3>();
  of_tip.tail<3>() -= turning.cross(lever);
  JointVector rates;
  kinematics.rates(dynamics_, of_tip, now_.position, posture, rates);
  return rates;
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

/// `onward`: what the joints do at full pace, besides what brings them back to the line. Braked, or for its power, the pace is the least that their accelerations permit.
void Setpoints::keep_pace(const JointVector& onward, const JointVector& back) noexcept {
  const double most = line_.pace(path_s_), power = power_.share(onward);
  if (!braking_ && power >= pace_) {
    pace_ = std::min({most, power, pace_ + line_.change_per_s(path_s_) * cycle_s_});
    return;
  }
  // Who brakes has his time for it; who is to give less power gives less at once.
  double least = braking_ ? std::min(power, std::max(0.0, pace_ - cycle_s_ / Line::ramp_s)) : power;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    if (std::abs(onward[i]) < no_way) continue;
    const double step = braking_share * bounds_[joint].motion.acceleration * cycle_s_;
    const double kept = now_.velocity[i] - back[i];
    least = std::max(least, std::min((kept - step) / onward[i], (kept + step) / onward[i]));
  }
  pace_ = std::min({least, pace_, most});
}

/// The survey has looked at some places; what lies between them keeps velocities and accelerations as well, and goes on slower.
void Setpoints::keep_limits(JointVector& rates) noexcept {
  double speed_share = 1, change_share = 1;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const double most = bounds_[joint].motion.velocity;
    if (std::abs(rates[i]) > most) speed_share = std::min(speed_share, most / std::abs(rates[i]));
  }
  rates *= speed_share;
  const JointVector change = rates - now_.velocity;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const double its = std::abs(change[static_cast<Eigen::Index>(joint)]);
    const double most = bounds_[joint].motion.acceleration * cycle_s_;
    if (its > most) change_share = std::min(change_share, most / its);
  }
  rates = now_.velocity + change_share * change;
  if (speed_share < 1 || change_share < 1)
    pace_ = std::max(std::min(pace_, slowest_pace), pace_ - 2 * line_.change_per_s(path_s_) * cycle_s_);
}

void Setpoints::advance_line() noexcept {
  if (path_s_ <= 0 && line_.found() != Line::Found::Way) {
    if (!braking_) line_.survey();
    if (braking_ || line_.found() == Line::Found::Nothing) come_to_rest();
    if (line_.found() != Line::Found::Way) return;
    pace_ = line_.pace(0);
    duration_s_ = line_.duration_s();
    return;
  }
  path_s_ += pace_ * cycle_s_;
  path_.at(path_s_, sample_);
  const double share = sample_.position[0], rate = sample_.velocity[0];
  const robotics::Pose here = tool(), wanted = line_.at(share);
  const Vector3 beside = wanted.position - here.position;
  off_line_m_ = beside.norm();
  Vector6 twist;
  twist.head<3>() = back_to_line_per_s * rotation_vector(wanted.rotation * here.rotation.transpose());
  twist.tail<3>() = back_to_line_per_s * beside;
  const JointVector back = tip_rates(line_.kinematics(), twist, now_.position);
  // Joints that the tool leaves free are drawn while it goes, and stand when it does.
  const JointVector drawn = now_.position + rate / line_.rate() * (posture_ - now_.position);
  const JointVector onward = tip_rates(line_.kinematics(), rate * line_.twist(), drawn);
  keep_pace(onward, back);
  JointVector rates = pace_ * onward + back;
  keep_limits(rates);
  follow(rates);
  const bool there = beside.norm() < 1e-7 && rates.cwiseAbs().maxCoeff() < 1e-5;
  const double behind_s = path_s_ - path_.duration_s();
  if ((braking_ && pace_ <= 0) || (behind_s >= 0 && (there || behind_s >= longest_settling_s))) come_to_rest();
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
    rate = std::min({rate, retract_share * its.velocity / share, std::sqrt(its.acceleration / share * left)});
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
