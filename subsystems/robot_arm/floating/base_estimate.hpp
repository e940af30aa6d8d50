// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "robotics/dynamics/spatial.hpp"

namespace hirosco::robot_arm {

/// Where a base is that floats, of noisy samples and of how the joints make it move between them. The first samples count alike, so that
/// a reference that is taken soon is a mean already; from `most_samples` on it follows slowly: of a noise of 1 mm about 0.16 mm stay,
/// and of a motion that nobody predicts it is late by `most_samples` of their periods.
/// Inertial axes, m. Thread: the cycle's; nothing is allocated.
class BaseEstimate {
 public:
  /// At 100 Hz 0.2 s.
  static constexpr std::uint32_t most_samples = 20;

  /// As if none had ever come: the next sample is taken as it is.
  void forget() noexcept { samples_ = 0; }
  /// Where nobody measures: the place in which it began.
  void stand_still() noexcept {
    forget();
    position_m_.setZero();
    orientation_.setIdentity();
  }

  /// A sample. One that is no place and attitude is passed over: a mean would never forget it.
  void take(const robotics::Vector3& position_m, const robotics::Quaternion& orientation) noexcept {
    const double norm = orientation.norm();
    if (!position_m.allFinite() || !std::isfinite(norm) || norm <= 0.5) return;
    samples_ = std::min(samples_ + 1, most_samples);
    const double weight = 1.0 / samples_;
    position_m_ += weight * (position_m - position_m_);
    orientation_ = orientation_.slerp(weight, orientation.normalized());
  }
  /// Each cycle, before its sample if there is one: `twist` in the base's own axes, rad/s and m/s.
  void go_on(const robotics::Vector6& twist, double cycle_s) noexcept {
    position_m_ += cycle_s * (orientation_ * robotics::Vector3{twist.tail<3>()});
    robotics::Quaternion by;
    by.w() = 1;
    by.vec() = 0.5 * cycle_s * twist.head<3>();
    orientation_ = (orientation_ * by).normalized();
  }

  [[nodiscard]] const robotics::Vector3& position_m() const noexcept { return position_m_; }
  [[nodiscard]] const robotics::Quaternion& orientation() const noexcept { return orientation_; }

 private:
  robotics::Vector3 position_m_{robotics::Vector3::Zero()};
  robotics::Quaternion orientation_{robotics::Quaternion::Identity()};
  std::uint32_t samples_{0};
};

}  // namespace hirosco::robot_arm
