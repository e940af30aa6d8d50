// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

/// How much electrical power there is, in numbers. No framework.  Realtime: wait-free.
namespace hirosco::power_supply {

struct Rule {
  double array_w{900};  ///< of the array in full sun
  double battery_w{150};  ///< that the battery is planned to add
  double least_charge{0.4};  ///< above which it does, share
};

struct Measured {
  double array_w{0};  ///< that the array can give now
  double sun_angle_deg{0};  ///< between the sun and the array's normal
  bool eclipse{false};
  double charge{0};  ///< of the battery, share
};

/// Of the array: by the sun's angle, and never more than it was measured to give; a cell string that is lost is seen in that alone.
[[nodiscard]] inline double from_array_w(const Rule& rule, const Measured& measured) noexcept {
  if (measured.eclipse) return 0;
  const double by_angle_w = rule.array_w * std::cos(measured.sun_angle_deg * std::numbers::pi / 180);
  return std::max(0.0, std::min(by_angle_w, measured.array_w));
}

[[nodiscard]] inline double available_w(const Rule& rule, const Measured& measured) noexcept {
  return from_array_w(rule, measured) + (measured.charge > rule.least_charge ? rule.battery_w : 0);
}

}  // namespace hirosco::power_supply
