// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/control/watch.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/tool_work.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Whether what is measured keeps the limits of file and descriptor.
/// Realtime: wait-free. Thread: the cycle, and the service loop while there is none.
class LimitWatch {
 public:
  struct Parts {
    const UrdfArm& known;
    Drives& drives;
    Parameters& parameters;
  };
  explicit LimitWatch(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure().
  void begin(double cycle_s) noexcept { work_.begin(cycle_s); }
  void arm() noexcept { watch_.arm(), work_.arm(); }
  /// Something was told since it was armed.
  [[nodiscard]] bool tripped() const noexcept { return watch_.tripped().has_value() || work_.tripped(); }
  /// Each cycle: what is to be told now; nothing mostly. `setpoint` null: nobody is to follow it.
  [[nodiscard]] std::optional<Finding> update(const JointVector* setpoint) noexcept;

  /// Besides, each cycle: force at the tool, and work. `free`: no brakes hold it, in whatever law and motion.
  [[nodiscard]] std::optional<WorkFinding> update_work(bool free) noexcept { return work_.update(free); }
  /// Brakes have just let it go: what the model feels by now is theirs.
  [[nodiscard]] bool lets_go() const noexcept { return work_.lets_go(); }
  /// Of force and work, as they are set.
  [[nodiscard]] WorkLimits work_limits() const noexcept { return work_.limits(); }
  /// What is told of them, each cycle, before update_work().
  [[nodiscard]] ToolWork& work() noexcept { return work_; }

  /// Running where each joint may hold so much; refused with the first that may not.
  [[nodiscard]] Outcome may_hold(const JointVector& torque) const noexcept;
  /// A limit that the arm's present load exceeds already would only stop it.
  [[nodiscard]] Outcome set_torque_limit(double share) noexcept;
  /// The same of what acts on the tool, N, and of power, W.
  [[nodiscard]] Outcome set_force_limit(double force_n) noexcept;
  [[nodiscard]] Outcome set_power_limits(double power_w, double tool_power_w) noexcept;

 private:
  [[nodiscard]] std::uint32_t without_zero() const noexcept;
  [[nodiscard]] Outcome below(double share, const JointVector& torque) const noexcept;

  Parts parts_;
  Watch watch_;
  ToolWork work_{{parts_.drives, parts_.parameters.tool_force_n, parts_.parameters.joint_power_w,
                  parts_.parameters.tool_power_w, parts_.parameters.tool_force_limit_n, parts_.parameters.power_limit_w,
                  parts_.parameters.tool_power_limit_w}};
};

}  // namespace hirosco::robot_arm
