// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_drive.hpp"

#include <cmath>
#include <span>

#include <Eigen/Cholesky>

namespace hirosco::robot_arm {
namespace {

/// So far it is looked where a torque would push an arm that rests, rad or m of the joint with the farthest way.
constexpr double looked_ahead = 0.01;

}  // namespace

void FloatingDrive::begin(double cycle_s) noexcept {
  cycle_s_ = cycle_s;
  drive_.begin(static_cast<Eigen::Index>(parts_.known.joints()));
  end();
}

/// What pushes into what is too near already would have it nearer with each word.
std::optional<FloatingReason> FloatingDrive::presses(const JointVector& torque) noexcept {
  const JointVector& here = parts_.drives.measured().position;
  const Eigen::LLT<FloatingModel::Square> moved{parts_.craft.model().inertia()};
  JointVector way = torque;
  moved.solveInPlace(way);
  const double most = way.cwiseAbs().maxCoeff();
  if (!(most > 0) || !way.allFinite()) return std::nullopt;
  const auto there = parts_.obstacles.nearer(here, here + looked_ahead / most * way);
  if (there.distance_m == HUGE_VAL) return std::nullopt;
  return FloatingReason{FloatingTrouble::too_near, there.names, millimetres(there.distance_m)};
}

std::optional<FloatingReason> FloatingDrive::want(const FunctionValues& values, bool goes_on) noexcept {
  const std::size_t joints = parts_.known.joints();
  const JointVector torque = vector_of(std::span{values}.first(joints));
  const double share = parts_.parameters.limits.load().torque;
  const Bounds bounds = parts_.known.bounds();
  for (std::size_t i = 0; i < joints; ++i)
    // Written so that what is no number is refused.
    if (!(std::abs(torque[static_cast<Eigen::Index>(i)]) < share * bounds[i].effort))
      return FloatingReason{FloatingTrouble::load_above_limit, "joint", static_cast<std::int64_t>(i + 1)};
  if (const auto why = presses(torque)) return why;
  if (!goes_on) drive_.begin(static_cast<Eigen::Index>(joints));
  drive_.want(torque);
  left_s_ = values[joints];
  return std::nullopt;
}

bool FloatingDrive::step() noexcept {
  if (left_s_ <= 0) return false;
  left_s_ -= cycle_s_;
  const FloatingModel& model = parts_.craft.model();
  const JointVector moved = model.inertia().diagonal() / model.heavier();
  const Driven& driven =
      drive_.step(parts_.drives.measured(), {.held = JointVector::Zero(moved.size()), .moved = moved},
                  parts_.known.bounds(), parts_.parameters.limits.load().torque, cycle_s_);
  parts_.parameters.desired_torque.store(joints_of(driven.torque));
  return true;
}

void FloatingDrive::end() noexcept {
  left_s_ = 0;
  parts_.parameters.desired_torque.store(Joints::zeros(parts_.known.joints()));
}

}  // namespace hirosco::robot_arm
