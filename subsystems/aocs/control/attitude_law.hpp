// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "robotics/dynamics/spatial.hpp"

/// The control of a craft's attitude, free of the framework: numbers in, numbers out, in the base's axes.
/// All of it: Realtime: wait-free. Thread: the cycle.
namespace hirosco::aocs {

using robotics::Quaternion;
using robotics::Vector3;

/// By which rotation, rad, the base is off its reference, in its own axes: 0 where it is to be, at most half a turn.
[[nodiscard]] inline Vector3 attitude_error(const Quaternion& reference, const Quaternion& measured) noexcept {
  Quaternion off = reference.conjugate() * measured;
  // Both signs are one attitude: the shorter way.
  if (off.w() < 0) off.coeffs() = -off.coeffs();
  const double sine = off.vec().norm();
  if (sine < 1e-12) return 2 * off.vec();
  return 2 * std::atan2(sine, off.w()) / sine * off.vec();
}

struct Gains {
  double stiffness_n_m{6};  ///< per rad
  double damping_n_m_s{60};  ///< per rad/s
};

/// A spring and a damper to the reference, each axis held to what its wheel has.
[[nodiscard]] inline Vector3 attitude_torque(const Vector3& error_rad, const Vector3& rate_rad_s, const Gains& gains,
                                             double most_n_m) noexcept {
  const Vector3 wanted = -(gains.stiffness_n_m * error_rad + gains.damping_n_m_s * rate_rad_s);
  return wanted.cwiseMax(-most_n_m).cwiseMin(most_n_m);
}

/// What wheels and thrusters give together so that the wheels lose what they have stored and the base feels nothing of it: added to the
/// wheels' torque, and the opposite of it by thrusters. `room`: what each wheel has left for it.
[[nodiscard]] inline Vector3 unloading_torque(const Vector3& stored_n_m_s, double per_s,
                                              const Vector3& room_n_m) noexcept {
  return (per_s * stored_n_m_s).cwiseMax(-room_n_m).cwiseMin(room_n_m);
}

/// Near its reference and slow for long enough.
class Settled {
 public:
  struct Limits {
    double error_rad{0.1 * std::numbers::pi / 180};
    double rate_rad_s{0.01 * std::numbers::pi / 180};
    double for_s{1};
  };
  void begin() noexcept {
    held_s_ = 0;
    told_ = false;
  }
  /// True once: from this cycle on it is settled, until it has left.
  [[nodiscard]] bool update(const Vector3& error_rad, const Vector3& rate_rad_s, double cycle_s,
                            const Limits& limits) noexcept {
    const bool within = error_rad.norm() < limits.error_rad && rate_rad_s.norm() < limits.rate_rad_s;
    held_s_ = within ? held_s_ + cycle_s : 0;
    told_ = told_ && within;
    settled_ = held_s_ >= limits.for_s;
    if (!settled_ || told_) return false;
    return told_ = true;
  }
  [[nodiscard]] bool now() const noexcept { return settled_; }

 private:
  double held_s_{0};
  bool settled_{false};
  bool told_{false};
};

}  // namespace hirosco::aocs
