// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// Holds joints, and moves them slowly, where nobody knows the arm's posture (docs/adr/0208): a spring, a damper and a slow integral at each by what that joint
/// alone measures, from wherever it is. No model of links: what a joint moves is never less than its rotor, and with more it only swings more slowly. So it needs
/// to know of no gravity, and is for an arm that weighs nothing. No joint is ever given more than a bound, whatever errors say.
class HomingLaw {
 public:
  struct Settings {
    double bandwidth_rad_s{40};
    std::span<const double> rotor{};  ///< of each joint, above 0, kg m2 or kg
    std::span<const double> most{};  ///< N m or N of each joint, not below 0
  };
  HomingLaw(const robotics::Model& model, double cycle_s);

  /// Forgets what it had learnt, and what pressed.
  void begin() noexcept;
  /// Numbers within `most`, 0 for what is none.
  [[nodiscard]] JointVector torque(const Setpoint& wanted, const Measured& measured, const Settings& settings) noexcept;
  /// The first joint that has had all of its torque, or has told more than that, for 20 ms: something is in its way.
  [[nodiscard]] std::optional<std::size_t> presses() const noexcept;

 private:
  void learn(Eigen::Index joint, double error, const Setpoint& wanted, const Measured& measured, double steepness,
             double most) noexcept;

  const robotics::Model* model_;
  double cycle_s_;
  JointVector integral_;  ///< rad s or m s
  std::array<std::uint32_t, max_joints> pressed_cycles_{};
  std::array<std::int8_t, max_joints> at_bound_{};  ///< of the last torque(): to which side
};

}  // namespace hirosco::robot_arm
