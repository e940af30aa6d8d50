// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_jog.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "subsystems/robot_arm/floating/floating_trouble.hpp"

namespace hirosco::robot_arm {

void FloatingJog::begin(double cycle_s) {
  const UrdfArm& known = parts_.known;
  setpoints_.emplace(known.model(), known.tip(), known.bounds(), cycle_s);
  cycle_s_ = cycle_s;
  end();
}

Outcome FloatingJog::joints(const FunctionValues& values, const JointVector& from) noexcept {
  const std::size_t joints = parts_.known.joints();
  if (of_ != Of::AllJoints) setpoints_->rest(from);
  of_ = Of::AllJoints;
  setpoints_->jog(vector_of(std::span{values}.first(joints)));
  left_s_ = values[joints];
  return running;
}

Outcome FloatingJog::tool(const std::array<double, 3>& moving_m_s, const std::array<double, 3>& turning_rad_s,
                          double span_s) noexcept {
  const Vector3 moving{moving_m_s[0], moving_m_s[1], moving_m_s[2]};
  const Vector3 turning{turning_rad_s[0], turning_rad_s[1], turning_rad_s[2]};
  const double speed = moving.norm();
  if (!(speed <= parts_.parameters.tool_speed_m_s.load()))
    return refused(FloatingTrouble::too_fast, "mm/s", std::llround(1e3 * speed));
  if (parts_.craft.law() == ToolLaw::AttitudeHold && !turning.isZero(0))
    return refused(FloatingTrouble::another_law, "it leaves the base unturned and turns no tool: ANGULAR is 0");
  if (of_ != Of::Tool) turning_ = moving_ = Vector3::Zero();
  of_ = Of::Tool;
  wanted_moving_ = moving;
  wanted_turning_ = turning;
  left_s_ = span_s;
  return running;
}

void FloatingJog::advance() noexcept {
  left_s_ = std::max(0.0, left_s_ - cycle_s_);
  if (of_ == Of::AllJoints) {
    if (left_s_ <= 0) setpoints_->brake();
    static_cast<void>(setpoints_->advance());
    return;
  }
  if (left_s_ <= 0) wanted_turning_ = wanted_moving_ = Vector3::Zero();
  turning_ = towards(turning_, wanted_turning_, tool_rad_s2 * cycle_s_);
  moving_ = towards(moving_, wanted_moving_, tool_m_s2 * cycle_s_);
}

bool FloatingJog::over() const noexcept {
  if (of_ == Of::AllJoints) return setpoints_->at_rest();
  return left_s_ <= 0 && turning_.isZero(0) && moving_.isZero(0);
}

}  // namespace hirosco::robot_arm
