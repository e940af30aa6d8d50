// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "subsystems/robot_gripper/control/fingers.hpp"

namespace hirosco::robot_gripper {
namespace {

Finger slide() { return {.closed = 0, .open = 0.05, .effort = 80, .velocity = 0.1, .moved = 2, .friction = 1}; }

TEST(Fingers, OneDriveThatMovesBothSidesPressesWithHalfOfIt) {
  const Fingers fingers{std::array{slide()}, 0.1};
  EXPECT_DOUBLE_EQ(fingers.width({0.02}), 0.04);
  EXPECT_DOUBLE_EQ(fingers.speed({-0.05}), -0.1);
  EXPECT_DOUBLE_EQ(fingers.force({-40}), 20);
  EXPECT_DOUBLE_EQ(fingers.most_force_n(), 40);
  EXPECT_DOUBLE_EQ(fingers.most_speed_m_s(), 0.2);
  EXPECT_DOUBLE_EQ(fingers.moved_kg(), 0.5);
  const Joints torques = fingers.torques(20, {{0.02}, {0}, {0}}, 40);
  ASSERT_EQ(torques.size(), 1u);
  EXPECT_DOUBLE_EQ(torques[0], -40);
}

TEST(Fingers, TwoDrivesPressWithAllOfEach) {
  const Fingers fingers{std::array{slide(), slide()}, 0.1};
  EXPECT_DOUBLE_EQ(fingers.width({0.02, 0.03}), 0.05);
  EXPECT_DOUBLE_EQ(fingers.force({-20, -20}), 20);
  EXPECT_DOUBLE_EQ(fingers.most_force_n(), 80);
  const Joints torques = fingers.torques(20, {{0.02, 0.02}, {0, 0}, {0, 0}}, 40);
  EXPECT_DOUBLE_EQ(torques[0], -20);
  EXPECT_DOUBLE_EQ(torques[1], -20);
  const Joints uneven = fingers.torques(0, {{0.02, 0.022}, {0, 0}, {0, 0}}, 40);
  EXPECT_GT(uneven[0], 0) << "who is behind is opened";
  EXPECT_LT(uneven[1], 0) << "who is ahead is closed";
}

TEST(Fingers, OfJointsThatTurnAndCloseAtTheirUpperEndForceIsWhatDoesTheSameWork) {
  const Finger turn{.closed = 0.8, .open = 0, .effort = 10, .velocity = 2, .moved = 0.01, .friction = 0};
  const Fingers fingers{std::array{turn}, 0.085};
  EXPECT_DOUBLE_EQ(fingers.width({0.8}), 0);
  EXPECT_DOUBLE_EQ(fingers.width({0}), 0.085);
  EXPECT_NEAR(fingers.force({1}) * 0.085, 1 * 0.8, 1e-12) << "over the whole range";
  EXPECT_GT(fingers.torques(5, {{0.4}, {0}, {0}}, 40)[0], 0);
}

TEST(Fingers, NeverAskForMoreThanAnEffortNorForWhatIsNoNumber) {
  const Fingers fingers{std::array{slide(), slide()}, 0.1};
  const Joints torques = fingers.torques(1e6, {{0, 0.05}, {0, 0}, {0, 0}}, 40);
  EXPECT_EQ(torques[0], -80);
  EXPECT_EQ(torques[1], -80);
  EXPECT_EQ(fingers.torques(NAN, {{0.02, 0.02}, {0, 0}, {0, 0}}, 40)[0], 0);
}

}  // namespace
}  // namespace hirosco::robot_gripper
