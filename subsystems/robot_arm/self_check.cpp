// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/self_check.hpp"

#include <cmath>

namespace hirosco::robot_arm {
namespace {

constexpr double rest_rad_s = 0.02;
constexpr double rest_m_s = 0.002;
/// rad or m, and of a joint's range.
constexpr double most_past_end = 0.05;
constexpr double displacement = 0.01;

}  // namespace

Result<Step> SelfCheck::step(const Cycle& cycle) noexcept {
  if (cycle.first) {
    tried_ = 0;
    HIROSCO_TRY(check_sensors());
  }
  const auto checked = check_law(tried_ / 2, tried_ % 2 == 0 ? 1.0 : -1.0);
  if (parts_.homing.in_force()) parts_.homing.engage();
  else parts_.yielding.engage();
  if (!checked) return fail(checked.error());
  return ++tried_ < 2 * parts_.known.joints() ? again : done;
}

/// Whose posture is not known is not moved by its model; nor does anybody know what holds it, where it weighs something.
Result<> SelfCheck::check_zeros() const noexcept {
  if (const auto forbidden = parts_.homing.forbids()) {
    if (!forbidden->joint)
      return fail(ErrorCode::NotPermitted, "GRAVITY is not 0: what weighs on it before HOME nobody knows");
    return fail(ErrorCode::NotPermitted, "does not know its zero: HOME where HOMING is on, joint",
                static_cast<std::int64_t>(*forbidden->joint + 1));
  }
  if (!parts_.homing.in_force()) return ok();
  const auto why = parts_.homing.unfit();
  return why ? fail(ErrorCode::NotPermitted, why->text, why->number) : ok();
}

Result<> SelfCheck::check_sensors() const noexcept {
  if (!parts_.drives.alive()) return fail(ErrorCode::Unavailable, "the arm says nothing");
  HIROSCO_TRY(check_zeros());
  const Bounds bounds = parts_.known.bounds();
  const Measured& measured = parts_.drives.measured();
  for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const auto number = static_cast<std::int64_t>(joint + 1);
    // Written so that what is no number fails.
    const bool slides = parts_.known.model().joints()[joint].kind == robotics::JointKind::Prismatic;
    if (!(std::abs(measured.velocity[i]) < (slides ? rest_m_s : rest_rad_s)))
      return fail(ErrorCode::Internal, "it moves though nothing drives it, joint", number);
    const double past = past_end(bounds[joint], most_past_end);
    if (parts_.homing.knows(joint) &&
        !(measured.position[i] > bounds[joint].lowest - past && measured.position[i] < bounds[joint].highest + past))
      return fail(ErrorCode::Internal, "measured outside of its range, joint", number);
    if (!(std::abs(measured.torque[i]) < parts_.parameters.torque_limit.load() * bounds[joint].effort))
      return fail(ErrorCode::Internal, "its load at rest is above its limit, joint", number);
  }
  return ok();
}

Result<> SelfCheck::check_law(std::size_t joint, double side) noexcept {
  const auto i = static_cast<Eigen::Index>(joint);
  const JointVector& measured = parts_.drives.measured().position;
  Setpoints& setpoints = parts_.guidance.setpoints();
  setpoints.rest(measured);
  const auto answer = [&](double deviation) {
    if (parts_.homing.in_force()) return parts_.homing.answer(joint, deviation);
    parts_.control.laws().reset();
    JointVector deviated = measured;
    deviated[i] += deviation;
    setpoints.rest(deviated);
    parts_.control.control();
    return parts_.drives.puts_out()[joint];
  };
  const double at_rest = answer(0);
  if (!(side * (answer(side * displacement) - at_rest) > 0))
    return fail(ErrorCode::Internal, "driven away from its setpoint, joint", static_cast<std::int64_t>(joint + 1));
  return ok();
}

}  // namespace hirosco::robot_arm
