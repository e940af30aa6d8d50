// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/robot_gripper/handling.hpp"

namespace hirosco::robot_gripper {

/// How a gripper tries itself for ST[17]: the sensors at rest, then a small deviation to each side, which the law has to answer against. What is
/// held stays held: nothing that it puts out reaches an actuator.
/// Realtime: bounded, no allocation. Thread: the cycle.
class SelfCheck {
 public:
  struct Parts {
    const Fingers& fingers;
    Drives& drives;
    Handling& handling;
    const Parameters& parameters;
  };
  explicit SelfCheck(const Parts& parts) noexcept : parts_{parts} {}

  /// A cycle of it, behind one of Safe-Operational. `cycle.first`: it begins anew.
  [[nodiscard]] Result<Step> step(const Cycle& cycle) noexcept;

 private:
  [[nodiscard]] Result<> check_sensors() const noexcept;
  [[nodiscard]] Result<> check_law(double side) noexcept;

  Parts parts_;
  std::size_t tried_{0};  ///< sides
};

}  // namespace hirosco::robot_gripper
