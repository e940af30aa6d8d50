// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/guidance.hpp"
#include "subsystems/robot_arm/homing.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/torque_control.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"
#include "subsystems/robot_arm/yielding.hpp"

namespace hirosco::robot_arm {

/// How an arm tries itself for ST[17]: the sensors at rest, then a small deviation of each joint to each side, which the law has to answer against.
/// Nothing that it puts out reaches an actuator.
/// Realtime: bounded, no allocation. Thread: the cycle.
class SelfCheck {
 public:
  struct Parts {
    const UrdfArm& known;
    Drives& drives;
    Guidance& guidance;
    TorqueControl& control;
    Yielding& yielding;
    Homing& homing;
    const Parameters& parameters;
  };
  explicit SelfCheck(const Parts& parts) noexcept : parts_{parts} {}

  /// A cycle of it, behind one of Safe-Operational. `cycle.first`: it begins anew.
  [[nodiscard]] Result<Step> step(const Cycle& cycle) noexcept;

 private:
  [[nodiscard]] Result<> check_zeros() const noexcept;
  [[nodiscard]] Result<> check_sensors() const noexcept;
  [[nodiscard]] Result<> check_law(std::size_t joint, double side) noexcept;

  Parts parts_;
  std::size_t tried_{0};  ///< each joint to each side
};

}  // namespace hirosco::robot_arm
