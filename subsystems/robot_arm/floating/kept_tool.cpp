// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/kept_tool.hpp"

#include <algorithm>
#include <numbers>

namespace hirosco::robot_arm {
namespace {

/// Of the filter before the tool's error, which single samples of a star tracker would hide.
constexpr double error_filter_s = 0.5;
/// m and rad that a tool which is led may be behind: from half of it on its goal goes slower, and at all of it stands. Noise of the base's pose is a
/// thirtieth of it, what a law is behind of a tool that speeds up a fiftieth.
constexpr double leash_m = 0.01, leash_rad = 0.02;

}  // namespace

void KeptTool::keep_base() noexcept {
  if (!base_let_go_) return;
  base_ = parts_.craft.attitude();
  base_let_go_ = false;
}

void KeptTool::begin_course(const Vector3& offset_m, double duration_s, const PreferredPosture& preferred) noexcept {
  preferred_ = preferred;
  duration_s_ = duration_s;
  pace_ = 0;
  from_ = goal_.pose.position;
  offset_ = offset_m;
}

void KeptTool::go(const Course& at) noexcept {
  goal_.pose.position = from_ + at.share * offset_;
  goal_.velocity_m_s = at.per_s * offset_;
  pace_ = pace(at, duration_s_);
}

void KeptTool::lead(const Vector3& turning_rad_s, const Vector3& moving_m_s, double cycle_s, Leash leash) noexcept {
  const robotics::Pose& tool = parts_.craft.tool();
  double behind = (goal_.pose.position - tool.position).norm() / leash_m;
  if (parts_.craft.law() != ToolLaw::AttitudeHold)
    behind = std::max(behind, rotation_between(tool.rotation, goal_.pose.rotation).norm() / leash_rad);
  const double pace = leash == Leash::Goes ? 1 : std::clamp(2 * (1 - behind), 0.0, 1.0);
  goal_.velocity_m_s = pace * moving_m_s;
  goal_.turning_rad_s = pace * turning_rad_s;
  goal_.pose.position += cycle_s * goal_.velocity_m_s;
  robotics::Quaternion by;
  by.w() = 1;
  by.vec() = 0.5 * cycle_s * goal_.turning_rad_s;
  goal_.pose.rotation = (by * robotics::Quaternion{goal_.pose.rotation}).normalized().toRotationMatrix();
}

JointVector KeptTool::rates(Bounds bounds) const noexcept {
  const FloatingCraft& craft = parts_.craft;
  if (!(pace_ > 0) || !preferred_.draws())
    return tool_rates(craft.law(), craft.model(), bounds, goal_, craft.attitude(), base_);
  const JointVector drawn = drawn_to(preferred_, craft.model().position(), bounds, pace_);
  return tool_rates(craft.law(), craft.model(), bounds, goal_, craft.attitude(), base_, &drawn);
}

/// The mean of the way that is left, not of its length: noise of the base's place has no direction.
void KeptTool::measure(double cycle_s) noexcept {
  const Vector3 left = goal_.pose.position - parts_.craft.tool().position;
  mean_left_m_ += (left - mean_left_m_) * (cycle_s / error_filter_s);
  error_m_ = mean_left_m_.norm();
}

void KeptTool::forget_error() noexcept {
  mean_left_m_.setZero();
  error_m_ = 0;
}

void KeptTool::tell() noexcept {
  constexpr double deg = 180 / std::numbers::pi;
  parts_.parameters.error.store(
      {error_m_, deg * rotation_between(parts_.craft.tool().rotation, goal_.pose.rotation).norm()});
}

}  // namespace hirosco::robot_arm
