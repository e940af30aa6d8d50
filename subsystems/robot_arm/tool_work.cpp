// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/tool_work.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// Until then drives may not yet give what they are told, and what brakes held would be taken for something from outside.
constexpr double felt_after_s = 0.05;
/// Brakes that take longer to open leave drives without torque, which those then tell: so long at most.
constexpr double opened_after_s = 0.5;
/// Of the largest torque that is commanded: who gives less does not give it yet.
constexpr double gives_share = 0.1;

}  // namespace

WorkLimits ToolWork::limits() const noexcept {
  return {parts_.force_limit_n.load(), parts_.power_limit_w.load(), parts_.tool_power_limit_w.load()};
}

WorkWatch::Is ToolWork::is() const noexcept {
  const auto force = parts_.force_n.load();
  return {Vector3{force[0], force[1], force[2]}.norm(), parts_.power_w.load(), parts_.tool_power_w.load()};
}

/// In this way what is no number stays none, and is beyond every limit.
void ToolWork::tell(const Vector3& force_n, const Vector3& velocity_m_s) noexcept {
  const Measured& measured = parts_.drives.measured();
  parts_.force_n.store({force_n.x(), force_n.y(), force_n.z()});
  parts_.tool_power_w.store(std::abs(force_n.dot(velocity_m_s)));
  const JointVector work_w = measured.torque.cwiseProduct(measured.velocity);
  parts_.power_w.store(0.5 * (work_w + work_w.cwiseAbs()).sum());
}

bool ToolWork::feels() const noexcept { return free_s_ > felt_after_s; }

/// What is no number counts as given: it is beyond every limit, and is not to be waited for.
bool ToolWork::gives() const noexcept {
  double wanted = 0;
  for (const double torque : parts_.drives.puts_out()) wanted = std::max(wanted, std::abs(torque));
  return !(parts_.drives.measured().torque.cwiseAbs().maxCoeff() < gives_share * wanted);
}

std::optional<WorkFinding> ToolWork::update(bool free) noexcept {
  waited_s_ = free ? waited_s_ + cycle_s_ : 0;
  const bool opening = waited_s_ > felt_after_s && !feels() && waited_s_ <= opened_after_s && !gives();
  if (!free) free_s_ = 0;
  else if (!opening) free_s_ += cycle_s_;
  return watch_.update(is(), limits(), feels());
}

std::optional<ToolWork::Above> ToolWork::set_force_limit(double force_n) noexcept {
  const double is_n = feels() ? is().force_n : 0;
  if (!(is_n < force_n)) return Above{"N at the tool", is_n};
  parts_.force_limit_n.store(force_n);
  return std::nullopt;
}

std::optional<ToolWork::Above> ToolWork::set_power_limits(double power_w, double tool_power_w) noexcept {
  const WorkWatch::Is now = is();
  if (!(now.power_w < power_w)) return Above{"W of all joints", now.power_w};
  if (feels() && !(now.tool_power_w < tool_power_w)) return Above{"W of the tool", now.tool_power_w};
  parts_.power_limit_w.store(power_w);
  parts_.tool_power_limit_w.store(tool_power_w);
  return std::nullopt;
}

}  // namespace hirosco::robot_arm
