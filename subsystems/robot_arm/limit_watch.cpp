// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/limit_watch.hpp"

#include <cmath>

#include "subsystems/robot_arm/trouble.hpp"

namespace hirosco::robot_arm {
namespace {

[[nodiscard]] Outcome outcome_of(const std::optional<ToolWork::Above>& above) noexcept {
  if (above) return refused(Trouble::load_above_limit, above->what, std::llround(above->is));
  return ok();
}

}  // namespace

std::optional<Finding> LimitWatch::update(const JointVector* setpoint) noexcept {
  const Parameters& values = parts_.parameters;
  const Watch::Limits limits{.speed_share = values.speed_limit.load(),
                             .torque_share = values.torque_limit.load(),
                             .torque_hard_share = values.torque_hard.load(),
                             .following = values.following_limit.load(),
                             .without_zero = without_zero()};
  return watch_.update(parts_.drives.measured(), setpoint, parts_.known.bounds(), limits);
}

std::uint32_t LimitWatch::without_zero() const noexcept {
  std::uint32_t joints = 0;
  for (std::size_t joint = 0; joint < parts_.known.joints(); ++joint)
    if (!parts_.drives.referenced(joint)) joints |= std::uint32_t{1} << joint;
  return joints;
}

Outcome LimitWatch::set_force_limit(double force_n) noexcept { return outcome_of(work_.set_force_limit(force_n)); }

Outcome LimitWatch::set_power_limits(double power_w, double tool_power_w) noexcept {
  return outcome_of(work_.set_power_limits(power_w, tool_power_w));
}

Outcome LimitWatch::set_torque_limit(double share) noexcept {
  const JointVector& torque = parts_.drives.measured().torque;
  if (torque.size() == 0) return refused(pus::FailureCode::NotPermittedNow);
  if (const Outcome may = below(share, torque); may.kind == Outcome::Kind::Refused) return may;
  parts_.parameters.torque_limit.store(share);
  return ok();
}

Outcome LimitWatch::may_hold(const JointVector& torque) const noexcept {
  return below(parts_.parameters.torque_limit.load(), torque);
}

Outcome LimitWatch::below(double share, const JointVector& torque) const noexcept {
  const Bounds bounds = parts_.known.bounds();
  for (std::size_t i = 0; i < bounds.size(); ++i)
    if (!(std::abs(torque[static_cast<Eigen::Index>(i)]) < share * bounds[i].effort))
      return refused(Trouble::load_above_limit, "joint", static_cast<std::int64_t>(i + 1));
  return running;
}

}  // namespace hirosco::robot_arm
