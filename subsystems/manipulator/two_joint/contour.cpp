// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/two_joint/contour.hpp"

#include <numbers>

namespace hirosco::manipulator::two_joint {

Point pressed_finger(const Surroundings& surroundings, double y_m, double depth_m) noexcept {
  const double across = y_m - surroundings.bump_y_m;
  double x = surroundings.rail_x_m;
  double slope = 0;
  if (std::abs(across) < surroundings.bump_half_width_m) {
    const double wave = std::numbers::pi / surroundings.bump_half_width_m;
    const double half = surroundings.bump_height_m / 2;
    x -= half * (1 + std::cos(wave * across));
    slope = half * wave * std::sin(wave * across);
  }
  const double out_m = (surroundings.finger_radius_m - depth_m) / std::hypot(1.0, slope);
  return {x - out_m, y_m + slope * out_m};
}

double Contour::gap_m(const Joints& position_rad) const noexcept {
  const Point tip_m = tip(geometry_, position_rad);
  const Surroundings around;
  constexpr int points_each_side = 6;
  constexpr double apart_m = 0.004;
  double nearest_m = HUGE_VAL;
  double across_m = 0;
  for (int k = -points_each_side; k <= points_each_side; ++k) {
    // The surface is where a finger would be that is pressed in by its own radius.
    const Point surface = pressed_finger(around, tip_m[1] + k * apart_m, around.finger_radius_m);
    const double distance_m = std::hypot(surface[0] - tip_m[0], surface[1] - tip_m[1]);
    if (k == 0) across_m = surface[0] - tip_m[0];
    nearest_m = std::min(nearest_m, distance_m);
  }
  return (across_m < 0 ? -nearest_m : nearest_m) - around.finger_radius_m;
}

double distance_to_spring(std::size_t spring, const Point& tip_m) noexcept {
  const Point& end = springs[spring - 1].slack_end_m;
  return std::hypot(tip_m[0] - end[0], tip_m[1] - end[1]);
}

}  // namespace hirosco::manipulator::two_joint
