// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/control/opening.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hirosco::robot_gripper {

void Opening::rest(double width_m) noexcept { brake_from(width_m, 0); }

void Opening::brake_from(double width_m, double speed_m_s) noexcept {
  path_.reset();
  now_ = {width_m, speed_m_s, 0};
}

void Opening::brake() noexcept { brake_from(now_.width_m, now_.speed_m_s); }

Result<> Opening::go(double width_m, double speed_m_s) noexcept {
  robotics::JointVector from, to;
  from.setConstant(1, now_.width_m);
  to.setConstant(1, width_m);
  const std::array limits{robotics::MotionLimits{speed_m_s, acceleration_, jerk_}};
  auto planned = robotics::PointToPoint::plan(from, to, limits);
  if (!planned) return fail(planned.error());
  path_ = *planned;
  gone_s_ = 0;
  return ok();
}

void Opening::advance() noexcept {
  if (path_) {
    gone_s_ += cycle_s_;
    path_->at(gone_s_, sample_);
    now_ = {sample_.position[0], sample_.velocity[0], sample_.acceleration[0]};
    if (gone_s_ >= path_->duration_s()) rest(now_.width_m);
    return;
  }
  const double slower = std::max(0.0, std::abs(now_.speed_m_s) - acceleration_ * cycle_s_);
  const double next = std::copysign(slower, now_.speed_m_s);
  now_ = {now_.width_m + cycle_s_ * (now_.speed_m_s + next) / 2, slower > 0 ? next : 0,
          (next - now_.speed_m_s) / cycle_s_};
}

double Opening::progress() const noexcept {
  return path_ && path_->duration_s() > 0 ? std::min(1.0, gone_s_ / path_->duration_s()) : 1;
}

}  // namespace hirosco::robot_gripper
