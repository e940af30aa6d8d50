// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/manipulator/control/joints.hpp"

namespace hirosco::manipulator {

struct Gains {
  double kp_n_m_per_rad{300};
  double kd_n_m_s_per_rad{24};
  /// Of the law without its torque feedback: what the joint is loaded with at rest is no more, whatever the gains.
  double effort_max_n_m{60};
  /// By how much the position error may ask for more than the joint holds already: what is let go, or loses contact, is
  /// caught up with slowly.
  double surplus_max_n_m{60};
};

/// Gains on their way to the wanted ones: they change at a bounded rate, so that a new gain is never a blow.
class GainRamp {
 public:
  static constexpr double kp_rate_per_s = 500;
  static constexpr double kd_rate_per_s = 50;

  /// At once: for a controller that begins at rest.
  void reset(const Gains& gains) noexcept { now_ = gains; }
  /// Moves on towards `wanted` and returns what holds now.
  const Gains& advance(const Gains& wanted, double span_s) noexcept;
  [[nodiscard]] const Gains& now() const noexcept { return now_; }
  [[nodiscard]] bool reached(const Gains& wanted) const noexcept {
    return now_.kp_n_m_per_rad == wanted.kp_n_m_per_rad && now_.kd_n_m_s_per_rad == wanted.kd_n_m_s_per_rad;
  }

 private:
  Gains now_{};
};

/// Position control of flexible joints, each for itself, with torque feedback:
///   u = kp (qd - theta) + kd (qd' - theta'),   tau_m = 4 u - 3 tau_j,
/// which makes a motor feel a quarter as heavy. qd' is the filtered difference of qd. u is kept within the effort of
/// the gains.
class JointController {
 public:
  /// `period_s` of the cycle, above 0.
  JointController(std::size_t joints, double period_s) noexcept
      : period_s_{period_s}, last_{Joints::zeros(joints)}, velocity_{Joints::zeros(joints)} {}
  /// Forgets the past: the next call sees `desired` standing still.
  void reset(const Joints& desired_rad) noexcept;
  /// Motor torque, N m, within +-torque_max_n_m.
  [[nodiscard]] Joints motor_torque(const Joints& desired_rad, const Measured& measured, const Gains& gains) noexcept;
  [[nodiscard]] const Joints& desired_velocity_rad_s() const noexcept { return velocity_; }

  static constexpr double torque_max_n_m = 60;

 private:
  double period_s_;
  Joints last_;
  Joints velocity_;
};

/// How an arm's torques come from its controller.
using Law = Joints (*)(JointController& controller, const Joints& desired_rad, const Measured& measured,
                       const Gains& gains) noexcept;
inline Joints joint_law(JointController& controller, const Joints& desired_rad, const Measured& measured,
                        const Gains& gains) noexcept {
  return controller.motor_torque(desired_rad, measured, gains);
}

}  // namespace hirosco::manipulator
