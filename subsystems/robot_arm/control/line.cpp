// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/line.hpp"

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/control/pose_search.hpp"

namespace hirosco::robot_arm {
namespace {

constexpr double ramp_share = 0.25;
constexpr double shortest_way = 1e-9;
/// Of a step: so often it is tried; what is left is borne by an arm whose joints cannot have every orientation.
constexpr int most_tries = 4;
constexpr double most_left_m = 1e-3, most_left_rad = 0.01;
/// Of a joint's velocity; of its acceleration: for bends of its way and the ramps of the path, and for the pace that goes up and down. What is left of it is for
/// whoever comes back to the line, and for what lies between two steps.
constexpr double speed_share = 0.95, bend_share = 0.6, change_share = 0.3;
constexpr double least_pace = 0.01;

/// Small errors of a posture are large ones of an acceleration.
[[nodiscard]] constexpr robotics::InverseKinematicsOptions exactly() noexcept {
  robotics::InverseKinematicsOptions options = a_little_at_a_time;
  options.tolerance = 1e-9;
  return options;
}

}  // namespace

Line::Line(const robotics::Model& model, robotics::FrameId tip, Bounds bounds)
    : bounds_{bounds}, kinematics_{model, tip, exactly()} {
  two_back_.setZero(model.joint_count());
  one_back_ = next_ = two_back_;
}

Result<> Line::plan(const robotics::Pose& from, const robotics::Pose& goal, const robotics::Pose& tool_in_tip,
                    const Speed& speed, const JointVector& posture) noexcept {
  from_ = from;
  tool_ = tool_in_tip;
  preferred_ = {};
  way_m_ = goal.position - from.position;
  const Vector3 turn = rotation_vector(goal.rotation * from.rotation.transpose());
  angle_ = turn.norm();
  axis_ = angle_ > shortest_way ? Vector3{turn / angle_} : Vector3::UnitZ();
  const double length = length_m();
  if (length < shortest_way && angle_ < shortest_way) return fail(ErrorCode::InvalidArgument, "it is there already");
  // From 0 to 1, as fast as the slower of the two goes.
  rate_ = std::min(length > shortest_way ? speed.linear_m_s / length : HUGE_VAL,
                   angle_ > shortest_way ? speed.angular_rad_s / angle_ : HUGE_VAL);
  const double acceleration = rate_ / ramp_s;
  const std::array limits{robotics::MotionLimits{rate_, acceleration, acceleration / (ramp_share * ramp_s)}};
  HIROSCO_TRY_LET(path_, robotics::PointToPoint::plan(JointVector::Zero(1), JointVector::Ones(1), limits));
  found_ = Found::NotYet;
  reached_ = 0;
  tries_ = 0;
  two_back_ = one_back_ = next_ = posture;
  postures_.fill(posture);
  return ok();
}

robotics::Pose Line::at(double share) const noexcept {
  return {Eigen::AngleAxisd{share * angle_, axis_} * from_.rotation, from_.position + share * way_m_};
}

Vector6 Line::twist() const noexcept {
  Vector6 twist;
  twist.head<3>() = angle_ * axis_;
  twist.tail<3>() = way_m_;
  return twist;
}

double Line::share_at(std::size_t step) const noexcept {
  robotics::PointToPoint::Sample sample;
  path_.at(static_cast<double>(step) * step_s(), sample);
  return sample.position[0];
}

// --- the survey ----------------------------------------------------------------------------------------------------------

void Line::survey() noexcept {
  if (found_ != Found::NotYet) return;
  const robotics::Pose tip = at(share_at(reached_ + 1)) * robotics::inverse(tool_);
  const JointVector drawn = drawn_to();
  if (!kinematics_.solve(tip, drawn, next_)) {
    if (++tries_ < most_tries) return;
    if (!nearly_there(tip)) {
      found_ = Found::Nothing;
      return;
    }
  }
  take_step();
}

/// In this step, as whoever goes along it does at any pace: the tool's share of its way draws them.
JointVector Line::drawn_to() const noexcept {
  if (!preferred_.draws()) return next_;  // to nowhere else
  const double share = share_at(reached_ + 1) - share_at(reached_);
  return one_back_ + (1 - std::exp(-preferred_.gain_per_s * share / rate_)) * (preferred_.joints - one_back_);
}

bool Line::nearly_there(const robotics::Pose& tip) noexcept {
  const Vector6 left = kinematics_.left(tip, next_);
  return left.tail<3>().norm() <= most_left_m && left.head<3>().norm() <= most_left_rad;
}

void Line::take_step() noexcept {
  tries_ = 0;
  if (reached_ > 0) bound(reached_);
  two_back_ = one_back_;
  one_back_ = next_;
  postures_[++reached_] = next_;
  if (reached_ == steps) {
    smooth();
    found_ = Found::Way;
    return;
  }
  // About where it goes on to.
  next_ += one_back_ - two_back_;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    double& its = next_[static_cast<Eigen::Index>(joint)];
    its = std::clamp(its, bounds_[joint].lowest, bounds_[joint].highest);
  }
}

/// By the postures before and behind it.
void Line::bound(std::size_t step) noexcept {
  double most = 1, change = 1 / ramp_s;
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const robotics::MotionLimits& its = bounds_[joint].motion;
    const double speed = std::abs(next_[i] - two_back_[i]) / (2 * step_s());
    const double bend = std::abs(next_[i] - 2 * one_back_[i] + two_back_[i]) / (step_s() * step_s());
    if (speed > speed_share * its.velocity) most = std::min(most, std::pow(speed_share * its.velocity / speed, 2));
    if (bend > bend_share * its.acceleration) most = std::min(most, bend_share * its.acceleration / bend);
    if (change * speed > change_share * its.acceleration) change = change_share * its.acceleration / speed;
  }
  square_[step] = std::max(most, least_pace * least_pace);
  change_[step] = change;
}

/// Slower before a slow place, and behind it, so that the pace changes as slowly as it has to: its square does so by twice that in a step.
void Line::smooth() noexcept {
  square_[0] = square_[1], change_[0] = change_[1];
  square_[steps] = square_[steps - 1], change_[steps] = change_[steps - 1];
  const auto next_to = [&](std::size_t step, std::size_t other) {
    square_[step] = std::min(square_[step], square_[other] + 2 * step_s() * std::min(change_[step], change_[other]));
  };
  for (std::size_t step = 1; step <= steps; ++step) next_to(step, step - 1);
  for (std::size_t step = steps; step-- > 0;) next_to(step, step + 1);
}

std::optional<std::size_t> Line::joint_in_the_way() const noexcept { return at_its_end(bounds_, next_); }

double Line::free_m() const noexcept { return share_at(reached_) * length_m(); }

double Line::pace(double path_s) const noexcept {
  const double place = std::clamp(path_s / step_s(), 0.0, static_cast<double>(steps));
  const std::size_t step = std::min(static_cast<std::size_t>(place), steps - 1);
  return std::sqrt(std::lerp(square_[step], square_[step + 1], place - static_cast<double>(step)));
}

double Line::change_per_s(double path_s) const noexcept {
  const double place = std::clamp(path_s / step_s(), 0.0, static_cast<double>(steps));
  const std::size_t step = std::min(static_cast<std::size_t>(place), steps - 1);
  return std::min(change_[step], change_[step + 1]);
}

JointVector Line::posture_at(double path_s) const noexcept {
  const double place = std::clamp(path_s / step_s(), 0.0, static_cast<double>(steps));
  const std::size_t step = std::min(static_cast<std::size_t>(place), steps - 1);
  return postures_[step] + (place - static_cast<double>(step)) * (postures_[step + 1] - postures_[step]);
}

JointVector Line::onward(double path_s) const noexcept {
  const double place = std::clamp(path_s / step_s(), 0.0, static_cast<double>(steps));
  const std::size_t step = std::min(static_cast<std::size_t>(place), steps - 1);
  return (postures_[step + 1] - postures_[step]) / step_s();
}

double Line::duration_s() const noexcept {
  double duration_s = 0;
  for (std::size_t step = 0; step < steps; ++step)
    duration_s += 2 * step_s() / (std::sqrt(square_[step]) + std::sqrt(square_[step + 1]));
  return duration_s;
}

}  // namespace hirosco::robot_arm
