// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/straight_way.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "subsystems/robot_arm/control/trail.hpp"

namespace hirosco::robot_arm {
namespace {

[[nodiscard]] JointVector of_two(double one, double other) { return vector_of(std::array{one, other}); }

struct StraightWayTest : ::testing::Test {
  StraightWay way;
  std::vector<JointVector> looked_at;

  void look(const JointVector& from, const JointVector& goal, double cycle_s = 0.001) {
    way.begin(from, goal, cycle_s);
    looked_at.clear();
    while (looked_at.size() < 10'000 && way.step()) looked_at.push_back(way.posture());
  }
};

TEST_F(StraightWayTest, IsLookedAtEvenlyAndAtItsEnd) {
  look(of_two(0.1, 0), of_two(0.5, 1));
  ASSERT_EQ(looked_at.size(), 50u) << "each 0.02 rad of who has farthest to go";
  EXPECT_LT(apart(looked_at.back(), of_two(0.5, 1)), 1e-12);
  EXPECT_LT(apart(looked_at.front(), of_two(0.108, 0.02)), 1e-12);
  EXPECT_LT(apart(looked_at[24], of_two(0.3, 0.5)), 1e-12);
}

TEST_F(StraightWayTest, TakesNoMoreThan64PosturesNorATenthOfASecondHoweverFarItIs) {
  look(of_two(-3, 0), of_two(3, 0));
  EXPECT_EQ(looked_at.size(), 64u);
  look(of_two(-3, 0), of_two(3, 0), 0.004);
  EXPECT_EQ(looked_at.size(), 25u) << "with the longest cycle that is taken";
  look(of_two(-3, 0), of_two(3, 0), 0.2);
  EXPECT_EQ(looked_at.size(), 1u) << "its goal";
  EXPECT_LT(apart(looked_at.back(), of_two(3, 0)), 1e-12);
}

TEST_F(StraightWayTest, OfWhoIsThereIsItsGoal) {
  look(of_two(1, 2), of_two(1, 2));
  EXPECT_EQ(looked_at.size(), 1u);
}

TEST_F(StraightWayTest, TellsHowMuchOfItIsBefore) {
  way.begin(of_two(0, 0), of_two(1, 0), 0.001);
  EXPECT_EQ(way.share(), 0);
  for (int i = 0; i < 25; ++i) ASSERT_TRUE(way.step());
  EXPECT_DOUBLE_EQ(way.share(), 0.5);
}

}  // namespace
}  // namespace hirosco::robot_arm
