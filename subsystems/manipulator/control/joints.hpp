// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "hirosco/parameter/sized.hpp"

/// The control of an arm with any number of joints, free of the framework: numbers in, numbers out.
/// All of it: Realtime: bounded, no allocation, no system call. Thread: the cycle.
namespace hirosco::manipulator {

/// Memory for the numbers of an arm; how many joints it has its descriptor says. As in robotics/dynamics.
inline constexpr std::size_t max_joints = 16;
/// A number for each joint; those of one arm are all of one length.
using Joints = Sized<double, max_joints>;
using Temperatures = Sized<float, max_joints>;

/// The largest of their sizes; no number when one of them is none.
[[nodiscard]] inline double largest(const Joints& numbers) noexcept {
  double most = 0;
  for (const double number : numbers) {
    if (std::isnan(number)) return number;
    most = std::max(most, std::abs(number));
  }
  return most;
}
[[nodiscard]] inline double largest_difference(const Joints& a, const Joints& b) noexcept {
  Joints difference = a;
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= b[i];
  return largest(difference);
}

/// One sample of the arm's sensors.
struct Measured {
  Joints motor_position_rad{};
  Joints motor_velocity_rad_s{};
  Joints position_rad{};
  Joints velocity_rad_s{};
  Joints torque_n_m{};
  /// Of an arm that rests at its zero.
  [[nodiscard]] static Measured zeros(std::size_t joints) noexcept {
    const Joints none = Joints::zeros(joints);
    return {none, none, none, none, none};
  }
};

[[nodiscard]] inline double towards(double now, double wanted, double step) noexcept {
  return now + std::clamp(wanted - now, -step, step);
}

}  // namespace hirosco::manipulator
