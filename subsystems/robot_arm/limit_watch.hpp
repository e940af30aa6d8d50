// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/control/watch.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Whether what is measured keeps the limits of file and descriptor.
/// Realtime: wait-free. Thread: the cycle, and the service loop while there is none.
class LimitWatch {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    Parameters& parameters;
  };
  explicit LimitWatch(const Parts& parts) noexcept : parts_{parts} {}

  void arm() noexcept { watch_.arm(); }
  /// Something was told since it was armed.
  [[nodiscard]] bool tripped() const noexcept { return watch_.tripped().has_value(); }
  /// Each cycle: what is to be told now; nothing mostly. `setpoint` null: nobody is to follow it.
  [[nodiscard]] std::optional<Finding> update(const JointVector* setpoint) noexcept;

  /// Running where each joint may hold so much; refused with the first that may not.
  [[nodiscard]] Outcome may_hold(const JointVector& torque) const noexcept;
  /// A limit that the arm's present load exceeds already would only stop it.
  [[nodiscard]] Outcome set_torque_limit(double share) noexcept;

 private:
  [[nodiscard]] Outcome below(double share, const JointVector& torque) const noexcept;

  Parts parts_;
  Watch watch_;
};

}  // namespace hirosco::robot_arm
