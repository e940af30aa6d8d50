// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/clutch.hpp"

#include <gtest/gtest.h>

namespace hirosco::manipulator {
namespace {

TEST(Clutch, CouplesWithoutAJumpAndScalesAfterwards) {
  Clutch clutch;
  clutch.engage({-0.8, 1.6}, {0.05, -0.03});
  EXPECT_EQ(clutch.desired({0.05, -0.03}, 0.5), (Joints{-0.8, 1.6}));
  EXPECT_NEAR(clutch.desired({0.15, -0.03}, 0.5)[0], -0.75, 1e-12);
}

TEST(Clutch, CouplesEachJointOfAnyNumberWithItsOwnAxis) {
  for (std::size_t joints = 1; joints <= max_joints; ++joints) {
    Clutch clutch;
    clutch.engage(Joints::zeros(joints), Joints::zeros(joints));
    for (std::size_t axis = 0; axis < joints; ++axis) {
      Joints handle = Joints::zeros(joints);
      handle[axis] = 0.25;
      EXPECT_EQ(clutch.desired(handle, 1), handle);
    }
  }
}

}  // namespace
}  // namespace hirosco::manipulator
