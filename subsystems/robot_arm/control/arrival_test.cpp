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

/// Beside a pose, along y, and turned off it about its z.
robotics::Pose off_pose(const robotics::Pose& pose, double beside_m, double turned_rad) {
  return {pose.rotation * Eigen::AngleAxisd{turned_rad, Vector3::UnitZ()}.toRotationMatrix(),
          pose.position + Vector3{0, beside_m, 0}};
}
const robotics::Pose end_of_path{Eigen::AngleAxisd{2.0, Vector3{1, 2, 3}.normalized()}.toRotationMatrix(),
                                 {0.4, 0.1, 0.3}};

TEST(Arrival, OfAPoseIsWhereTheToolIsTooAndTurnedAsItsPathEnds) {
  Arrival arrival;
  arrival.begin(Arrival::To::Goal);
  EXPECT_TRUE(arrival.there(joints_left(-0.009), tolerance_rad, off_pose(end_of_path, 0.002, 0.002)))
      << "nothing is said of the tool";
  EXPECT_FALSE(arrival.there(joints_left(-0.011), tolerance_rad, end_of_path));
  // Where it is to be is said; as its path ends it is beside that, by what is borne.
  const robotics::Pose goal = off_pose(end_of_path, 0.0005, 0.005);
  arrival.expect_tool(goal.position);
  EXPECT_FALSE(arrival.there(joints_left(0), tolerance_rad, off_pose(goal, 0.0011, 0)));
  EXPECT_TRUE(arrival.there(joints_left(0), tolerance_rad, off_pose(goal, 0.0009, 0.1))) << "its path has not ended";
  EXPECT_FALSE(arrival.path_ended());
  arrival.end_path(end_of_path);
  EXPECT_TRUE(arrival.path_ended());
  EXPECT_TRUE(arrival.there(joints_left(0), tolerance_rad, off_pose(end_of_path, 0.0014, 0.0009)));
  EXPECT_FALSE(arrival.there(joints_left(0), tolerance_rad, off_pose(end_of_path, -0.0006, 0)));
  EXPECT_FALSE(arrival.there(joints_left(0), tolerance_rad, off_pose(end_of_path, 0, 0.0011)));
  EXPECT_FALSE(arrival.there(joints_left(0), tolerance_rad, off_pose(end_of_path, 0, -0.0011)));
  EXPECT_FALSE(arrival.there(joints_left(0.011), tolerance_rad, end_of_path));
}

TEST(Arrival, OfAPostureIsWhereThatHasTheTool) {
  Arrival arrival;
  arrival.begin(Arrival::To::Goal);
  arrival.end_path(end_of_path);
  EXPECT_FALSE(arrival.there(joints_left(0), tolerance_rad, off_pose(end_of_path, 0.0011, 0)));
  EXPECT_TRUE(arrival.there(joints_left(0), tolerance_rad, off_pose(end_of_path, 0.0009, 0.1)))
      << "its joints say how it is turned";
  EXPECT_FALSE(arrival.there(joints_left(0.011), tolerance_rad, end_of_path));
  arrival.begin(Arrival::To::Goal);
  EXPECT_TRUE(arrival.there(joints_left(0), tolerance_rad, off_pose(end_of_path, 1, 1)))
      << "that was the motion before";
  EXPECT_FALSE(arrival.path_ended());
}

TEST(Arrival, OfWhoHasNoGoalAsksNothingOfTheTool) {
  for (const Arrival::To to : {Arrival::To::Nowhere, Arrival::To::WayBack}) {
    Arrival arrival;
    arrival.begin(to);
    arrival.end_path(end_of_path);
    EXPECT_TRUE(arrival.path_ended());
    EXPECT_TRUE(arrival.there(joints_left(-0.009), tolerance_rad, off_pose(end_of_path, 0.01, 0.01)));
    EXPECT_FALSE(arrival.there(joints_left(-0.011), tolerance_rad, end_of_path));
  }
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
