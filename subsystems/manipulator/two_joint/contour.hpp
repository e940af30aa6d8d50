// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/manipulator/control/setpoint_governor.hpp"
#include "subsystems/manipulator/two_joint/kinematics.hpp"

namespace hirosco::manipulator::two_joint {

/// Where the arm believes its surroundings to be: a rail along y with a cosine bump towards the arm.
struct Surroundings {
  double rail_x_m{0.350};
  double bump_height_m{0.010};
  double bump_half_width_m{0.040};
  double bump_y_m{0.05};
  double finger_radius_m{0.010};
};

/// Centre of a finger that is `depth_m` deep in the contour at the surface's ordinate `y_m`, along its true normal.
[[nodiscard]] Point pressed_finger(const Surroundings& surroundings, double y_m, double depth_m) noexcept;

/// The contour with its bump as high as it may be, before the finger.
class Contour final : public Surface {
 public:
  explicit Contour(const Geometry& geometry) noexcept : geometry_{geometry} {}
  /// Shortest distance of the finger to points 4 mm apart, so at most 0.2 mm too long.
  [[nodiscard]] double gap_m(const Joints& position_rad) const noexcept override;

 private:
  Geometry geometry_;
};

/// Where a spring's free end hangs and where its other end is fixed.
struct SpringPlace {
  Point anchor_m{};
  Point slack_end_m{};
};
inline constexpr std::array<SpringPlace, 2> springs{
    {{{0.3275, 0.050}, {0.3275, 0.000}}, {{0.280, -0.0215}, {0.330, -0.0215}}}};
inline constexpr double hook_reach_m = 0.005;
/// From the tip to the slack end; `spring` counts from 1.
[[nodiscard]] double distance_to_spring(std::size_t spring, const Point& tip_m) noexcept;

}  // namespace hirosco::manipulator::two_joint
