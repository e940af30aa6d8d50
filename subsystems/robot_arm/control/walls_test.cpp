// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/walls.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace hirosco::robot_arm {
namespace {

/// One joint that floats, from -1 to 1 rad: 2 kg m2 with a damper, which somebody pushes. Its spring takes 80 N m in the last 0.1 rad.
struct WallsOfFloat : ::testing::Test {
  static constexpr double cycle_s = 0.001, moved = 2, damping_per_s = 5;
  static constexpr JointBounds bounds{
      .lowest = -1, .highest = 1, .effort = 80, .motion = {.velocity = 1, .acceleration = 4, .jerk = 40}};
  FloatAims aims;
  Measured measured{JointVector::Zero(1), JointVector::Zero(1), JointVector::Zero(1)};
  double farthest{0};

  [[nodiscard]] double place() const { return measured.position[0]; }
  void let_go_at(double position) {
    measured.position[0] = position;
    measured.velocity[0] = 0;
    farthest = std::abs(position);
    aims.let_go();
  }
  void push(double torque, double seconds) {
    for (double t = 0; t < seconds; t += cycle_s) {
      aims.remember(measured.position);
      const double kept = walls(aims.of(0), 0, measured, 0, moved, bounds, robotics::fastest_rad_s(cycle_s));
      const double damped = -damping_per_s * moved * measured.velocity[0];
      measured.velocity[0] += cycle_s * (torque + kept + damped) / moved;
      measured.position[0] += cycle_s * measured.velocity[0];
      farthest = std::max(farthest, std::abs(place()));
    }
  }
};

TEST_F(WallsOfFloat, ThrowNobodyWhoIsLetGoNearAnEnd) {
  for (const double near : {0.97, -0.97}) {
    let_go_at(near);
    push(0, 2);
    EXPECT_EQ(place(), near);
  }
}

TEST_F(WallsOfFloat, HaveWhoeverIsPushedLongStandBeforeTheEnd) {
  for (const double way : {1.0, -1.0}) {
    let_go_at(0.5 * way);
    push(40 * way, 20);
    EXPECT_NEAR(place(), 0.95 * way, 1e-3) << "half of the effort in half of it";
    EXPECT_LT(farthest, 1);
  }
}

TEST_F(WallsOfFloat, BeginWhereWhoeverWasLetGoNearAnEndHasComeAwayFromIt) {
  for (const double way : {1.0, -1.0}) {
    let_go_at(0.97 * way);
    push(-20 * way, 0.1);
    const double least = std::abs(place());
    ASSERT_LT(least, 0.96);
    ASSERT_GT(least, 0.9);
    push(20 * way, 5);
    // It went on by what it had, so that its spring begins a little before.
    EXPECT_LE(std::abs(place()), least + 0.025 + 1e-3);
    EXPECT_GT(std::abs(place()), 0.9 + 0.025);
  }
}

TEST_F(WallsOfFloat, AreAsOfAnyJointForWhoeverHasComeOutOfThem) {
  let_go_at(0.97);
  push(-20, 1);
  ASSERT_LT(place(), 0.8);
  push(20, 5);
  EXPECT_NEAR(place(), 0.925, 1e-3);
}

/// Who was held at an end, and is let go there once more.
TEST_F(WallsOfFloat, BeginAnewWhereItIsLetGoAnew) {
  let_go_at(0);
  push(40, 10);
  const double held = place();
  ASSERT_NEAR(held, 0.95, 1e-3);
  let_go_at(held);
  push(0, 2);
  EXPECT_EQ(place(), held);
  // Who is not let go anew is pushed out of his spring.
  push(-20, 1), push(40, 10), push(0, 5);
  EXPECT_LT(place(), 0.92);
}

TEST_F(WallsOfFloat, PushWhoeverIsBeyondAnEndBackToIt) {
  let_go_at(1.02);
  push(0, 5);
  EXPECT_LT(place(), 1 + 1e-3);
  EXPECT_GT(place(), 0.95);
}

}  // namespace
}  // namespace hirosco::robot_arm
