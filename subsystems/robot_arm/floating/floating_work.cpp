// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_work.hpp"

namespace hirosco::robot_arm {

void FloatingWork::begin(double cycle_s) noexcept {
  work_.begin(cycle_s);
  pace_ = PowerPace{};
}

void FloatingWork::measure() noexcept {
  if (!offered_) return;
  const JointVector& velocity = parts_.drives.measured().velocity;
  lever_.update(ToolLever::Rows{parts_.craft.model().tool_of_free().bottomRows<3>()});
  work_.tell(lever_.force(parts_.contact.external()), lever_.velocity(velocity));
  pace_.set(JointVector::Zero(velocity.size()), parts_.known.bounds(), parts_.parameters.power_limit_w.load());
}

std::optional<WorkFinding> FloatingWork::watch(bool free) noexcept {
  if (!offered_) return std::nullopt;
  return work_.update(free);
}

}  // namespace hirosco::robot_arm
