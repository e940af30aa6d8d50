// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/work_watch.hpp"

namespace hirosco::robot_arm {

std::optional<WorkFinding> WorkWatch::update(const Is& is, const WorkLimits& limits, bool feels) noexcept {
  std::optional<WorkFinding> found;
  const auto look = [&](Work what, double value, double limit, bool known) {
    const auto kind = static_cast<std::size_t>(what);
    const bool beyond = history_[kind].add(known && !(value <= limit));
    if (!beyond || told_[kind] || found) return;
    told_[kind] = tripped_ = true;
    found = {what, value, limit};
  };
  look(Work::ToolForce, is.force_n, limits.force_n, feels);
  look(Work::ToolPower, is.tool_power_w, limits.tool_power_w, feels);
  look(Work::Power, is.power_w, limits.power_w, true);
  return found;
}

}  // namespace hirosco::robot_arm
