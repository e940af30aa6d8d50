// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "subsystems/robot_arm/force_sensor.hpp"
#include "subsystems/robot_arm/guidance.hpp"
#include "subsystems/robot_arm/torque_control.hpp"
#include "subsystems/robot_arm/yielding.hpp"

namespace hirosco::robot_arm {

/// Contacts as joints and wrist feel them, at different times: which of what they tell is another one.
/// Whether it is a contact at all: `joint_contact.hpp`, `force_sensor.hpp`; what is done about it: `yielding.hpp`.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class ContactWatch {
 public:
  struct Parts {
    const Guidance& guidance;
    const TorqueControl& control;
    Yielding& yielding;
    ForceSensor& force_sensor;
  };
  /// What a cycle has brought; nothing mostly.
  struct Met {
    std::optional<Yielding::Contact> by_joints{};
    std::optional<ForceSensor::Contact> at_wrist{};
    bool counts{false};  ///< it is to be answered
  };
  explicit ContactWatch(const Parts& parts) noexcept : parts_{parts} {}

  /// Whoever is met from now on is told and answered, whatever was before.
  void arm(Yielding::Before load) noexcept;
  /// Each cycle in which the arm is driven.
  [[nodiscard]] Met meet() noexcept;

 private:
  Parts parts_;
  std::uint32_t since_answered_{0};  ///< cycles, of the last one
  bool felt_at_wrist_{false};  ///< that one, first
};

}  // namespace hirosco::robot_arm
