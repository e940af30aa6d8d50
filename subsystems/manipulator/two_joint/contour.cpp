// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/two_joint/contour.hpp"

#include <numbers>

namespace hirosco::manipulator::two_joint {

namespace {

/// Ordinate from the top of the bump, as an angle: no bump from -pi and pi on.
double bump_rad(const Surroundings& around, double y_m) noexcept {
  return std::numbers::pi / around.bump_half_width_m * (y_m - around.bump_y_m);
}

double surface_x_m(const Surroundings& around, double y_m) noexcept {
  if (std::abs(y_m - around.bump_y_m) >= around.bump_half_width_m) return around.rail_x_m;
  return around.rail_x_m - around.bump_height_m / 2 * (1 + std::cos(bump_rad(around, y_m)));
}

double surface_slope(const Surroundings& around, double y_m) noexcept {
  if (std::abs(y_m - around.bump_y_m) >= around.bump_half_width_m) return 0;
  return around.bump_height_m / 2 * (std::numbers::pi / around.bump_half_width_m) * std::sin(bump_rad(around, y_m));
}

}  // namespace

Point pressed_finger(const Surroundings& surroundings, double y_m, double depth_m) noexcept {
  const double slope = surface_slope(surroundings, y_m);
  const double out_m = (surroundings.finger_radius_m - depth_m) / std::sqrt(1 + slope * slope);
  return {surface_x_m(surroundings, y_m) - out_m, y_m + slope * out_m};
}

double Contour::gap_m(const Joints& position_rad) const noexcept {
  const Point tip_m = tip(geometry_, position_rad);
  const Surroundings around;
  constexpr int points_each_side = 6;
  constexpr double apart_m = 0.004;
  double nearest_m2 = HUGE_VAL;
  for (int k = -points_each_side; k <= points_each_side; ++k) {
    const double y_m = tip_m[1] + k * apart_m;
    const double ahead_m = surface_x_m(around, y_m) - tip_m[0];
    const double aside_m = y_m - tip_m[1];
    nearest_m2 = std::min(nearest_m2, ahead_m * ahead_m + aside_m * aside_m);
  }
  const double nearest_m = std::sqrt(nearest_m2);
  const bool inside = surface_x_m(around, tip_m[1]) < tip_m[0];
  return (inside ? -nearest_m : nearest_m) - around.finger_radius_m;
}

double distance_to_spring(std::size_t spring, const Point& tip_m) noexcept {
  const Point& end = springs[spring - 1].slack_end_m;
  const Point way{tip_m[0] - end[0], tip_m[1] - end[1]};
  return std::sqrt(way[0] * way[0] + way[1] * way[1]);
}

}  // namespace hirosco::manipulator::two_joint
