// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/torque_mode.hpp"

#include <span>

#include "subsystems/robot_arm/trouble.hpp"

namespace hirosco::robot_arm {
namespace {

/// So far it is looked where a torque would push an arm that rests, rad or m of the joint with the farthest way.
constexpr double looked_ahead = 0.01;

}  // namespace

void TorqueMode::begin(double cycle_s) noexcept {
  cycle_s_ = cycle_s;
  left_s_ = 0;
  drive_.begin(static_cast<Eigen::Index>(parts_.known.joints()));
}

void TorqueMode::weigh() noexcept {
  parts_.model.dynamics().mass_matrix(mass_);
  const Joints rotor = parts_.parameters.rotor_inertia.load();
  for (Eigen::Index i = 0; i < mass_.rows(); ++i)
    if (static_cast<std::size_t>(i) < rotor.size()) mass_(i, i) += rotor[static_cast<std::size_t>(i)];
}

/// What pushes into what is too near already would have it nearer with each word.
Outcome TorqueMode::may_press(const JointVector& torque) noexcept {
  const JointVector& here = parts_.drives.measured().position;
  weigh();
  factors_.compute(mass_);
  JointVector way = torque;
  factors_.solveInPlace(way);
  const double most = way.cwiseAbs().maxCoeff();
  if (!(most > 0) || !way.allFinite()) return running;
  const auto there = parts_.obstacles.nearer(here, here + looked_ahead / most * way);
  if (there.distance_m == HUGE_VAL) return running;
  return refused(Trouble::too_near, there.names, millimetres(there.distance_m));
}

Outcome TorqueMode::drive(const FunctionValues& values) noexcept {
  const std::size_t joints = parts_.known.joints();
  const JointVector torque = vector_of(std::span{values}.first(joints));
  const JointVector held = parts_.model.held(parts_.model.payload()) + parts_.control.laws().carried();
  if (const Outcome may = parts_.limits.may_hold(held + torque); may.kind == Outcome::Kind::Refused) return may;
  if (const Outcome may = may_press(torque); may.kind == Outcome::Kind::Refused) return may;
  if (!drives()) {
    before_ = parts_.control.kind();
    drive_.begin(static_cast<Eigen::Index>(joints));
    parts_.control.laws().drive(drive_.driven());
    parts_.guidance.lead();
    parts_.yielding.take_law(LawKind::Torque);
    parts_.yielding.arm(Yielding::Before::Stands);
  }
  drive_.want(torque);
  left_s_ = values[joints];
  return running;
}

void TorqueMode::advance() noexcept {
  if (!drives()) return;
  if (left_s_ <= 0) {
    stand();
    return;
  }
  left_s_ -= cycle_s_;
  weigh();
  const JointVector held = parts_.model.held(parts_.model.payload()) + parts_.control.laws().carried();
  const Driven& driven = drive_.step(parts_.drives.measured(), {.held = held, .moved = mass_.diagonal()},
                                     parts_.known.bounds(), parts_.parameters.torque_limit.load(), cycle_s_);
  parts_.control.laws().drive(driven);
  parts_.parameters.desired_torque.store(joints_of(driven.torque));
}

void TorqueMode::end() noexcept {
  left_s_ = 0;
  parts_.parameters.desired_torque.store(Joints::zeros(parts_.known.joints()));
}

/// What it pressed against is there still, and was not met by who stands.
void TorqueMode::stand() noexcept {
  if (!drives()) return;
  end();
  parts_.yielding.take_law(before_);
  parts_.yielding.arm(Yielding::Before::Stands);
}

}  // namespace hirosco::robot_arm
