// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "subsystems/manipulator/control/joint_controller.hpp"
#include "subsystems/manipulator/drives.hpp"

namespace hirosco::manipulator {

/// From a setpoint to what is put out: the control law, its controller, and its gains on their way to the wanted ones.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Servo {
 public:
  struct Parts {
    Drives& drives;
    Parameters& parameters;  ///< KP, KD and TORQUE_HARD say the wanted gains; GAINS and DES_VELOCITY tell
  };
  /// `law`: how torques come from its controller.
  Servo(const Parts& parts, Law law) noexcept : parts_{parts}, law_{law} {}

  /// `period_s` of the cycle, above 0. To be called first.
  void configure(std::size_t joints, double period_s) noexcept { controller_.emplace(joints, period_s); }
  /// Forgets the past: the next cycle sees `setpoint_rad` standing still, and has the wanted gains at once.
  void rest(const Joints& setpoint_rad) noexcept;
  /// True: the wanted ones are in force.
  [[nodiscard]] bool advance_gains(double span_s) noexcept;
  /// A cycle of the law: what it finds is put out and told.
  void drive(const Joints& setpoint_rad) noexcept;
  /// What would be put out, with a setpoint that stands still.
  [[nodiscard]] Joints wish(const Joints& setpoint_rad, const Measured& measured) noexcept;

  /// In force.
  [[nodiscard]] const Gains& gains() const noexcept { return gains_.now(); }

 private:
  void put_out(const Joints& setpoint_rad, const Measured& measured) noexcept;
  [[nodiscard]] Gains wanted_gains() const noexcept;

  Parts parts_;
  Law law_;
  std::optional<JointController> controller_;
  GainRamp gains_;
};

}  // namespace hirosco::manipulator
