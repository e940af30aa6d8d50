// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/two_joint/contour.hpp"

#include <gtest/gtest.h>

namespace hirosco::manipulator::two_joint {
namespace {

TEST(PressedFinger, LiesInTheContourByItsDepthAlongTheTrueNormal) {
  const Surroundings around;
  EXPECT_NEAR(pressed_finger(around, 0, 0.006)[0], 0.350 - 0.010 + 0.006, 1e-12);
  EXPECT_NEAR(pressed_finger(around, 0.05, 0)[0], 0.350 - 0.010 - 0.010, 1e-12) << "on top of the bump";
  // On its flank: the centre is a finger's radius from the surface point, at a right angle to the surface.
  constexpr double y = 0.03, step = 1e-6;
  const Point surface = pressed_finger(around, y, around.finger_radius_m);
  const Point ahead = pressed_finger(around, y + step, around.finger_radius_m);
  const Point centre = pressed_finger(around, y, 0);
  EXPECT_NEAR(std::hypot(centre[0] - surface[0], centre[1] - surface[1]), 0.010, 1e-12);
  const double along = (centre[0] - surface[0]) * (ahead[0] - surface[0]) + (centre[1] - surface[1]) * step;
  EXPECT_NEAR(along / (0.010 * step), 0, 1e-4);
}

TEST(Contour, IsAsFarAsTheFingersCentreButItsRadius) {
  const Contour contour{Geometry{}};
  // On the straight rail, 30 mm beside the bump's foot.
  EXPECT_NEAR(contour.gap_m(joints_for({}, {0.330, -0.020})), 0.350 - 0.330 - 0.010, 1e-12);
  EXPECT_LT(contour.gap_m(joints_for({}, {0.352, -0.020})), 0) << "behind the surface";
}

TEST(Contour, IsComeToNoFasterThanAtContactSpeed) {
  constexpr double span_s = 0.0005;
  const Contour contour{Geometry{}};
  SetpointGovernor governor{&contour};
  const Geometry geometry;
  Joints at{-0.8, 1.6};  // 12.55 mm from the rail
  governor.reset(at);
  double last_x = tip(geometry, at)[0], fastest_there = 0, fastest = 0;
  for (int k = 0; k < 1000; ++k) {
    at = governor.advance({-0.8, 1.2}, at, {}, span_s);
    const double x = tip(geometry, at)[0];
    if (k > 0 && x > 0.339) fastest_there = std::max(fastest_there, (x - last_x) / span_s);
    if (k > 0) fastest = std::max(fastest, (x - last_x) / span_s);
    last_x = x;
  }
  EXPECT_LT(fastest_there, 0.060 + 20 * 0.0015);
  EXPECT_GT(fastest, 0.08) << "farther off it is faster";
  EXPECT_GT(last_x, 0.35) << "it goes on, slowly";
}

}  // namespace
}  // namespace hirosco::manipulator::two_joint
