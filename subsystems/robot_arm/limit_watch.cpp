// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/limit_watch.hpp"

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/trouble.hpp"

namespace hirosco::robot_arm {
namespace {

/// Until then drives may not yet give what they are told, and what brakes held would be taken for something from outside.
constexpr double felt_after_s = 0.05;
/// Brakes that take longer to open leave drives without torque, which those then tell: so long at most.
constexpr double opened_after_s = 0.5;
/// Of the largest torque that is commanded: who gives less does not give it yet.
constexpr double gives_share = 0.1;

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

WorkLimits LimitWatch::work_limits() const noexcept {
  const Parameters& values = parts_.parameters;
  return {values.tool_force_limit_n.load(), values.power_limit_w.load(), values.tool_power_limit_w.load()};
}

WorkWatch::Is LimitWatch::work() const noexcept {
  const Parameters& values = parts_.parameters;
  const auto force = values.tool_force_n.load();
  return {Vector3{force[0], force[1], force[2]}.norm(), values.joint_power_w.load(), values.tool_power_w.load()};
}

bool LimitWatch::feels() const noexcept { return free_s_ > felt_after_s; }

/// What is no number counts as given: it is beyond every limit, and is not to be waited for.
bool LimitWatch::gives() const noexcept {
  double wanted = 0;
  for (const double torque : parts_.drives.puts_out()) wanted = std::max(wanted, std::abs(torque));
  return !(parts_.drives.measured().torque.cwiseAbs().maxCoeff() < gives_share * wanted);
}

std::optional<WorkFinding> LimitWatch::update_work(bool free) noexcept {
  waited_s_ = free ? waited_s_ + cycle_s_ : 0;
  const bool opening = waited_s_ > felt_after_s && !feels() && waited_s_ <= opened_after_s && !gives();
  if (!free) free_s_ = 0;
  else if (!opening) free_s_ += cycle_s_;
  return work_.update(work(), work_limits(), feels());
}

Outcome LimitWatch::set_force_limit(double force_n) noexcept {
  const double is_n = feels() ? work().force_n : 0;
  if (!(is_n < force_n)) return refused(Trouble::load_above_limit, "N at the tool", std::llround(is_n));
  parts_.parameters.tool_force_limit_n.store(force_n);
  return ok();
}

Outcome LimitWatch::set_power_limits(double power_w, double tool_power_w) noexcept {
  const WorkWatch::Is is = work();
  if (!(is.power_w < power_w)) return refused(Trouble::load_above_limit, "W of all joints", std::llround(is.power_w));
  if (feels() && !(is.tool_power_w < tool_power_w))
    return refused(Trouble::load_above_limit, "W of the tool", std::llround(is.tool_power_w));
  parts_.parameters.power_limit_w.store(power_w);
  parts_.parameters.tool_power_limit_w.store(tool_power_w);
  return ok();
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
