// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/self_check.hpp"

#include <cmath>

namespace hirosco::robot_gripper {
namespace {

constexpr double still_m_s = 0.002;
constexpr double displacement_m = 0.0005;

}  // namespace

Result<Step> SelfCheck::step(const Cycle& cycle) noexcept {
  if (cycle.first) {
    tried_ = 0;
    HIROSCO_TRY(check_sensors());
  }
  const auto checked = check_law(tried_ == 0 ? 1.0 : -1.0);
  parts_.handling.engage();
  if (!checked) return fail(checked.error());
  return ++tried_ < 2 ? again : done;
}

Result<> SelfCheck::check_sensors() const noexcept {
  const Fingers& fingers = parts_.fingers;
  const Measured& measured = parts_.drives.measured();
  if (!parts_.drives.alive()) return fail(ErrorCode::Unavailable, "the gripper says nothing");
  // Written so that what is no number fails.
  if (!(std::abs(parts_.drives.gap().speed_m_s) < still_m_s))
    return fail(ErrorCode::Internal, "it moves though nothing drives it");
  for (std::size_t i = 0; i < fingers.count(); ++i) {
    const Finger& its = fingers[i];
    const double past = 0.05 * (its.highest() - its.lowest());
    if (!(measured.position[i] > its.lowest() - past && measured.position[i] < its.highest() + past))
      return fail(ErrorCode::Internal, "measured outside of its range, joint", static_cast<std::int64_t>(i + 1));
    if (!(std::abs(measured.torque[i]) < parts_.parameters.force_hard.load() * its.effort))
      return fail(ErrorCode::Internal, "its load at rest is above its limit, joint", static_cast<std::int64_t>(i + 1));
  }
  return ok();
}

Result<> SelfCheck::check_law(double side) noexcept {
  const auto answer_n = [&](double deviation_m) {
    parts_.handling.keep(parts_.drives.gap().width_m + deviation_m);
    parts_.handling.control();
    return -parts_.fingers.force(parts_.drives.puts_out());
  };
  const double at_rest_n = answer_n(0);
  if (!(side * (answer_n(side * displacement_m) - at_rest_n) > 0))
    return fail(ErrorCode::Internal, "driven away from its setpoint");
  return ok();
}

}  // namespace hirosco::robot_gripper
