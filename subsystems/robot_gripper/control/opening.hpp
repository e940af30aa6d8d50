// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "robotics/motion/point_to_point.hpp"

namespace hirosco::robot_gripper {

/// Where the gap between fingers is to be, from cycle to cycle: at rest, on its way to a width, or braking.
/// Realtime: bounded, no allocation. Thread: the cycle.
class Opening {
 public:
  struct Wanted {
    double width_m{0};
    double speed_m_s{0};
    double acceleration_m_s2{0};
  };
  Opening() = default;
  Opening(double acceleration_m_s2, double jerk_m_s3, double cycle_s) noexcept
      : acceleration_{acceleration_m_s2}, jerk_{jerk_m_s3}, cycle_s_{cycle_s} {}

  void rest(double width_m) noexcept;
  /// Brakes from there.
  void brake_from(double width_m, double speed_m_s) noexcept;
  void brake() noexcept;
  /// From rest. InvalidArgument: no numbers.
  [[nodiscard]] Result<> go(double width_m, double speed_m_s) noexcept;
  void advance() noexcept;

  [[nodiscard]] const Wanted& now() const noexcept { return now_; }
  [[nodiscard]] bool at_rest() const noexcept { return !path_ && now_.speed_m_s == 0; }
  [[nodiscard]] double duration_s() const noexcept { return path_ ? path_->duration_s() : 0; }
  /// 0 to 1 of its time.
  [[nodiscard]] double progress() const noexcept;

 private:
  Wanted now_;
  std::optional<robotics::PointToPoint> path_;
  robotics::PointToPoint::Sample sample_;
  double gone_s_{0};
  double acceleration_{1}, jerk_{10}, cycle_s_{0.001};
};

}  // namespace hirosco::robot_gripper
