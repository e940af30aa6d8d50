// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "simulation/devices/joystick/joystick_handle.hpp"

namespace hirosco::simulation {

/// A hand that a pointer leads: its target may leap or shake as a mouse does, the hand goes after it as a careful person would who
/// feels the robot through the handle. None of its limits needs to know where the wall is:
/// - rate: what the moving masses put into a joint at an impact grows with it; a hand that feels something goes slower;
/// - acceleration: what carrying the links takes of a joint's torque grows with it;
/// - pull: how far the hand presses on against what it feels. The handle shows 0.02 of a joint's torque, so 0.12 N m of pull are
///   6 N m in rest, wherever the wall is and wherever the clutch was engaged.
/// Together they keep the joints below their 12 N m, 9 N m in the worst of what tests/integration/led_hand_test.cpp tries
/// (docs/adr/0030).
/// Realtime: wait-free. Thread: one.
class LedHand {
 public:
  struct Limits {
    Vec2 rate_rad_s{0.3, 0.3};
    double acceleration_rad_s2{4};
    double pull_n_m{0.12};
    double calming{0.75};  ///< share of the rate that a hand gives up at its full pull
  };

  explicit LedHand(const Limits& limits) noexcept : limits_{limits} {}

  /// From here on; the target is here too.
  void begin(const Intent& now) noexcept {
    wish_ = now;
    target_rad_ = now.angle_rad;
  }
  void lead(const Vec2& target_rad) noexcept { target_rad_ = target_rad; }
  /// `handle_rad`: where the handle is, of which the hand never goes farther ahead than its pull stretches `stiffness`.
  void advance(const Vec2& handle_rad, double stiffness_n_m_per_rad, double span_s) noexcept {
    const double ahead_rad = limits_.pull_n_m / stiffness_n_m_per_rad;
    double pulled = 0;
    for (std::size_t i = 0; i < 2; ++i)
      pulled = std::max(pulled, std::abs(wish_.angle_rad[i] - handle_rad[i]) / ahead_rad);
    const double calm = 1 - limits_.calming * std::min(pulled, 1.0);
    for (std::size_t i = 0; i < 2; ++i) {
      double& rate = wish_.rate_rad_s[i];
      double& angle = wish_.angle_rad[i];
      // Slows down towards the target within what the acceleration allows.
      const double fastest = calm * limits_.rate_rad_s[i];
      const double wanted =
          std::clamp((target_rad_[i] - angle) * limits_.acceleration_rad_s2 / limits_.rate_rad_s[i], -fastest, fastest);
      const double change = limits_.acceleration_rad_s2 * span_s;
      rate += std::clamp(wanted - rate, -change, change);
      const double free = angle + rate * span_s;
      angle = std::clamp(free, handle_rad[i] - ahead_rad, handle_rad[i] + ahead_rad);
      if (angle != free) rate = 0;
    }
  }
  [[nodiscard]] const Limits& limits() const noexcept { return limits_; }
  [[nodiscard]] const Intent& intent() const noexcept { return wish_; }

 private:
  Limits limits_;
  Intent wish_{};
  Vec2 target_rad_{};
};

}  // namespace hirosco::simulation
