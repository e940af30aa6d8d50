// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/power_pace.hpp"
#include "subsystems/robot_arm/control/tool_lever.hpp"
#include "subsystems/robot_arm/floating/floating_contact.hpp"
#include "subsystems/robot_arm/floating/floating_craft.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/tool_work.hpp"

namespace hirosco::robot_arm {

/// With which force the tool of a craft that floats presses, and how much work it does (docs/adr/0235): what acts on it by the Jacobian of a craft without momentum, in the axes of TOOL. Whose descriptor
/// does not have the limits has none.
/// Realtime: bounded. Thread: the cycle, and the service loop while there is none.
class FloatingWork {
 public:
  struct Parts {
    const UrdfArm& known;
    Drives& drives;
    const FloatingCraft& craft;
    const FloatingContact& contact;
    FloatingParameters& parameters;
  };
  explicit FloatingWork(const Parts& parts) noexcept : parts_{parts} {}

  /// The descriptor has SET_FORCE_LIMIT and SET_POWER_LIMIT.
  void offer() noexcept { offered_ = true; }
  /// In configure().
  void begin(double cycle_s) noexcept;
  /// What was told is told anew.
  void arm() noexcept { work_.arm(); }
  [[nodiscard]] bool tripped() const noexcept { return work_.tripped(); }
  /// Each cycle, behind craft and contact, of what is measured.
  void measure() noexcept;
  /// Each cycle, behind that: what is to be told now; nothing mostly. `free`: no brakes hold it.
  [[nodiscard]] std::optional<WorkFinding> watch(bool free) noexcept;

  /// Of measure(); none, where nothing bounds it.
  [[nodiscard]] const ToolLever* lever() const noexcept { return offered_ ? &lever_ : nullptr; }
  [[nodiscard]] WorkLimits limits() const noexcept { return work_.limits(); }
  /// How fast joints may go for their power; nothing hangs at them.
  [[nodiscard]] const PowerPace& pace() const noexcept { return pace_; }
  /// For SET_FORCE_LIMIT and SET_POWER_LIMIT.
  [[nodiscard]] ToolWork& work() noexcept { return work_; }

 private:
  Parts parts_;
  ToolWork work_{{parts_.drives, parts_.parameters.tool_force_n, parts_.parameters.joint_power_w,
                  parts_.parameters.tool_power_w, parts_.parameters.tool_force_limit_n, parts_.parameters.power_limit_w,
                  parts_.parameters.tool_power_limit_w}};
  ToolLever lever_;
  PowerPace pace_;
  bool offered_{false};
};

}  // namespace hirosco::robot_arm
