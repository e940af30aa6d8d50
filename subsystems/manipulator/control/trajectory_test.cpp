// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/trajectory.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace hirosco::manipulator {
namespace {

TEST(ShortestDuration, KeepsAMinimumJerkMotionWithinItsSpeedAndItsAcceleration) {
  for (const double way : {0.01, 0.1, 0.5, 2.0}) {
    const MotionLimits limits{.speed_rad_s = 1, .acceleration_rad_s2 = 10};
    const double duration_s = shortest_duration_s({0, 0.3}, {way, 0.3}, limits);
    Trajectory motion;
    motion.start({0, 0.3}, {way, 0.3}, duration_s);
    double last = 0, last_speed = 0, fastest = 0, hardest = 0;
    constexpr int steps = 4000;
    for (int k = 0; k < steps; ++k) {
      const double at = motion.advance(duration_s / steps)[0];
      const double speed = (at - last) * steps / duration_s;
      if (k > 0) hardest = std::max(hardest, std::abs(speed - last_speed) * steps / duration_s);
      fastest = std::max(fastest, speed);
      last = at;
      last_speed = speed;
    }
    EXPECT_LE(fastest, 1.001);
    EXPECT_LE(hardest, 10.01);
    EXPECT_TRUE(fastest > 0.999 || hardest > 9.99) << "and is no slower than it must be";
  }
}

TEST(ShortestDuration, IsThatOfTheJointWithTheLongestWayWhicheverItIs) {
  const double alone_s = shortest_duration_s({0}, {0.8}, path_limits);
  for (std::size_t joints = 1; joints <= max_joints; ++joints)
    for (std::size_t longest = 0; longest < joints; ++longest) {
      Joints to = Joints::zeros(joints);
      for (double& way : to) way = 0.1;
      to[longest] = -0.8;
      EXPECT_EQ(shortest_duration_s(Joints::zeros(joints), to, path_limits), alone_s);
    }
}

TEST(Trajectory, GoesFromRestToRestThroughTheMiddleAtItsPeakSpeed) {
  Trajectory motion;
  motion.start({0, 1}, {0.4, 0.2}, 2);
  EXPECT_FALSE(motion.done());
  (void)motion.advance(0.999);
  const double before = motion.position_rad()[1];
  (void)motion.advance(0.001);
  EXPECT_NEAR(motion.position_rad()[0], 0.2, 1e-12);
  EXPECT_NEAR(motion.progress(), 0.5, 1e-12);
  EXPECT_NEAR((before - motion.position_rad()[1]) / 0.001, 1.875 * 0.8 / 2, 1e-5) << "30 s^2 (1 - s)^2 at half time";
  EXPECT_EQ(motion.advance(5), (Joints{0.4, 0.2}));
  EXPECT_TRUE(motion.done());
}

TEST(Trajectory, ArrivesAtOnceWithoutTime) {
  Trajectory motion;
  motion.start({0, 0}, {1, 1}, 0);
  EXPECT_TRUE(motion.done());
  EXPECT_EQ(motion.position_rad(), (Joints{1, 1}));
}

TEST(Trajectory, MovesAllJointsOfAnyNumberInStep) {
  for (std::size_t joints = 1; joints <= max_joints; ++joints) {
    Joints from = Joints::zeros(joints), to = from;
    for (std::size_t i = 0; i < joints; ++i) {
      from[i] = 0.25 * static_cast<double>(i);
      to[i] = from[i] + (i % 2 == 0 ? 1.0 : -0.5);
    }
    Trajectory motion;
    motion.start(from, to, 1);
    for (int k = 0; k < 9; ++k) {
      const Joints at = motion.advance(0.1);
      for (std::size_t i = 0; i < joints; ++i)
        EXPECT_NEAR((at[i] - from[i]) / (to[i] - from[i]), minimum_jerk(motion.progress()), 1e-12);
    }
    EXPECT_EQ(motion.advance(0.2), to);
  }
}

TEST(Arrival, IsMeasuredAndMissedWhenItDoesNotComeInTime) {
  constexpr double cycle = 0.0005;
  Arrival arrival;
  arrival.start();
  EXPECT_EQ(arrival.judge({0.1, 0}, {0.104, 0}, 0.005, cycle), Arrival::Verdict::There);
  int cycles = 0;
  while (arrival.judge({0.1, 0}, {0.1, 0.006}, 0.005, cycle) == Arrival::Verdict::UnderWay) ++cycles;
  EXPECT_NEAR(cycles * cycle, Arrival::patience_s, 2 * cycle);
  arrival.start();
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(arrival.judge({none, 0}, {0, 0}, 0.005, cycle), Arrival::Verdict::There);
  EXPECT_NE(arrival.judge({0, none}, {0, 0}, 0.005, cycle), Arrival::Verdict::There);
}

}  // namespace
}  // namespace hirosco::manipulator
