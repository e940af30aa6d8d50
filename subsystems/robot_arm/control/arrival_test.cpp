// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/arrival.hpp"

#include <gtest/gtest.h>

#include <array>

namespace hirosco::robot_arm {
namespace {

constexpr double arrival_cycle_s = 0.004;
constexpr double tolerance_rad = 0.01;

/// Of two joints, of which one has so much left.
JointVector joints_left(double rad) { return vector_of(std::array{0.0, rad}); }

TEST(Arrival, IsSettledOnceTheGoalWasMeasuredLongEnough) {
  Arrival arrival;
  arrival.begin(Arrival::To::Goal);
  for (int i = 0; i < 4; ++i) arrival.wait(true, arrival_cycle_s);
  EXPECT_FALSE(arrival.settled());
  arrival.wait(false, arrival_cycle_s);
  for (int i = 0; i < 4; ++i) arrival.wait(true, arrival_cycle_s);
  EXPECT_FALSE(arrival.settled()) << "what was measured before it left again counts for nothing";
  for (int i = 0; i < 2; ++i) arrival.wait(true, arrival_cycle_s);
  EXPECT_TRUE(arrival.settled());
}

TEST(Arrival, IsOverdueThreeSecondsAfterTheEndOfThePath) {
  Arrival arrival;
  arrival.begin(Arrival::To::Goal);
  for (double waited_s = 0; waited_s < 2.9; waited_s += arrival_cycle_s) arrival.wait(false, arrival_cycle_s);
  EXPECT_FALSE(arrival.overdue());
  for (double waited_s = 0; waited_s < 0.2; waited_s += arrival_cycle_s) arrival.wait(false, arrival_cycle_s);
  EXPECT_TRUE(arrival.overdue());
  arrival.begin(Arrival::To::Goal);
  EXPECT_FALSE(arrival.overdue()) << "the next motion has its own time";
}

TEST(Arrival, OfAPoseIsWhereTheToolIsToo) {
  Arrival arrival;
  arrival.begin(Arrival::To::Goal);
  const Vector3 tool_goal_m{0.4, 0.1, 0.3};
  const Vector3 beside_m = tool_goal_m + Vector3{0, 0.002, 0};
  EXPECT_TRUE(arrival.there(joints_left(-0.009), tolerance_rad, beside_m)) << "nothing is said of the tool";
  EXPECT_FALSE(arrival.there(joints_left(-0.011), tolerance_rad, beside_m));
  arrival.expect_tool(tool_goal_m);
  EXPECT_FALSE(arrival.there(joints_left(0), tolerance_rad, beside_m));
  EXPECT_TRUE(arrival.there(joints_left(0), tolerance_rad, tool_goal_m + Vector3{0, 0.0009, 0}));
  EXPECT_FALSE(arrival.there(joints_left(0.011), tolerance_rad, tool_goal_m));
}

TEST(Arrival, TellsHalfOfItOnceAndOnlyOfWhoHasAGoal) {
  Arrival arrival;
  arrival.begin(Arrival::To::Goal);
  EXPECT_FALSE(arrival.tell_half(false));
  EXPECT_TRUE(arrival.tell_half(true));
  EXPECT_FALSE(arrival.tell_half(true));
  arrival.begin(Arrival::To::WayBack);
  EXPECT_TRUE(arrival.goes_back());
  EXPECT_FALSE(arrival.tell_half(true));
  arrival.begin(Arrival::To::Nowhere);
  EXPECT_FALSE(arrival.goes_back());
  EXPECT_FALSE(arrival.tell_half(true));
}

}  // namespace
}  // namespace hirosco::robot_arm
