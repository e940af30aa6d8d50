// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/two_joint/kinematics.hpp"

#include <gtest/gtest.h>

namespace hirosco::manipulator::two_joint {
namespace {

TEST(TipForce, IsTheForceWhoseMomentsAreTheJointTorques) {
  const Joints q{-0.8, 1.6};
  const Geometry geometry;
  const Point at = tip(geometry, q);
  // Moments of a force f at the tip about both joints: (x fy - y fx).
  const Point f{40, -7};
  const double x2 = at[0] - 0.25 * std::cos(q[0]);
  const double y2 = at[1] - 0.25 * std::sin(q[0]);
  const Joints torque{at[0] * f[1] - at[1] * f[0], x2 * f[1] - y2 * f[0]};
  const Point found = tip_force(geometry, q, torque);
  EXPECT_NEAR(found[0], 40, 1e-9);
  EXPECT_NEAR(found[1], -7, 1e-9);
}

TEST(TipForce, IsNotToldWhereTheArmIsStretched) { EXPECT_EQ(tip_force({}, {0.3, 0.0}, {1, 1}), (Point{0, 0})); }

TEST(JointsFor, UndoTheTipAndReachAsFarAsTheyCan) {
  for (const Joints& q : {Joints{-0.8, 1.6}, Joints{0.3, 0.4}, Joints{-1.5, 2.5}}) {
    const Joints back = joints_for({}, tip({}, q));
    EXPECT_NEAR(back[0], q[0], 1e-12);
    EXPECT_NEAR(back[1], q[1], 1e-12);
  }
  const Joints stretched = joints_for({}, {3, 4});
  EXPECT_NEAR(stretched[0], std::atan2(4, 3), 1e-12);
  EXPECT_EQ(stretched[1], 0);
}

}  // namespace
}  // namespace hirosco::manipulator::two_joint
