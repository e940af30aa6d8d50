// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

using testing::bounds_of;
using testing::model_of;

struct SetpointsTest : ::testing::Test {
  static constexpr double cycle_s = 0.001;
  /// Behind its end a line still finds the last of them.
  static constexpr double last_digits = 1e-5;
  robotics::Model model = model_of(testing::six_axes);
  std::vector<JointBounds> bounds = bounds_of(model);
  Setpoints setpoints{model, model.find_frame("tool").value(), bounds, cycle_s};
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector before;

  SetpointsTest() {
    setpoints.rest(start);
    before = start;
  }
  /// Another cycle, which keeps ranges, velocities and accelerations, and tells no other velocity than it moves with.
  void advance(double acceleration_factor = 1) {
    const JointVector speed_before = setpoints.now().velocity;
    const Setpoint& now = setpoints.advance();
    for (std::size_t joint = 0; joint < 6; ++joint) {
      const auto i = static_cast<Eigen::Index>(joint);
      ASSERT_GE(now.position[i], bounds[joint].lowest - 1e-9);
      ASSERT_LE(now.position[i], bounds[joint].highest + 1e-9);
      ASSERT_LE(std::abs(now.velocity[i]), bounds[joint].motion.velocity * (1 + 1e-9));
      ASSERT_LE(std::abs(now.velocity[i] - speed_before[i]),
                acceleration_factor * bounds[joint].motion.acceleration * cycle_s * (1 + 1e-6) + 1e-9);
      ASSERT_NEAR(now.position[i] - before[i], now.velocity[i] * cycle_s, 0.002 * cycle_s + 5e-6);
    }
    before = now.position;
  }
  void finish(int most = 60'000) {
    while (!setpoints.at_rest() && most-- > 0) ASSERT_NO_FATAL_FAILURE(advance());
    ASSERT_TRUE(setpoints.at_rest());
  }
};

TEST_F(SetpointsTest, GoesToAnyPlaceOfAllRangesWithinItsLimits) {
  std::mt19937 random{3};
  for (int i = 0; i < 20; ++i) {
    JointVector goal = start;
    for (std::size_t joint = 0; joint < 6; ++joint)
      goal[static_cast<Eigen::Index>(joint)] =
          std::uniform_real_distribution<double>{bounds[joint].lowest, bounds[joint].highest}(random);
    ASSERT_TRUE(setpoints.go(goal, i % 2 == 0 ? 1.0 : 0.3));
    ASSERT_NO_FATAL_FAILURE(finish());
    EXPECT_LT((setpoints.now().position - goal).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST_F(SetpointsTest, BrakesOnItsPathWhereverItIsOnIt) {
  const JointVector goal = vector_of(std::array{-1.5, -0.5, 0.2, 0.9, -0.7, 2.0});
  std::vector<robotics::MotionLimits> limits;
  for (const JointBounds& its : bounds) limits.push_back(its.motion);
  const auto path = robotics::PointToPoint::plan_straight(start, goal, limits).value();
  for (int cycles = 50; cycles < 1500; cycles += 150) {
    setpoints.rest(start);
    before = start;
    ASSERT_TRUE(setpoints.go(goal, 1));
    for (int i = 0; i < cycles && !setpoints.at_rest(); ++i) ASSERT_NO_FATAL_FAILURE(advance());
    setpoints.brake();
    ASSERT_NO_FATAL_FAILURE(finish(2000));
    double beside = HUGE_VAL;
    robotics::PointToPoint::Sample sample;
    for (double t = 0; t < path.duration_s(); t += 1e-4) {
      path.at(t, sample);
      beside = std::min(beside, (sample.position - setpoints.now().position).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(beside, 3e-4) << "after " << cycles << " cycles";
  }
}

TEST_F(SetpointsTest, HaltsFromWhereItIsWithFourTimesItsAccelerationsAtMost) {
  ASSERT_TRUE(setpoints.go(vector_of(std::array{-1.5, -0.5, 0.2, 0.9, -0.7, 2.0}), 1));
  for (int i = 0; i < 600; ++i) ASSERT_NO_FATAL_FAILURE(advance());
  const JointVector from = setpoints.now().position, velocity = setpoints.now().velocity;
  setpoints.halt(from, velocity);
  int cycles = 0;
  while (!setpoints.at_rest() && cycles < 1000) {
    ASSERT_NO_FATAL_FAILURE(advance(4));
    ++cycles;
  }
  EXPECT_NEAR(cycles * cycle_s, velocity.cwiseAbs().maxCoeff() / 16, 0.003);
  for (Eigen::Index i = 0; i < 6; ++i)
    EXPECT_NEAR(setpoints.now().position[i] - from[i], velocity[i] * std::abs(velocity[i]) / 32, 0.002) << i;
}

TEST_F(SetpointsTest, GoesStraightAndTurnsMeanwhile) {
  const robotics::Pose from = setpoints.tool();
  robotics::Pose goal = from;
  goal.position += Vector3{-0.15, 0.25, -0.1};
  goal.rotation = Eigen::AngleAxisd{0.6, Vector3{1, 2, -1}.normalized()} * goal.rotation;
  const Vector3 way = goal.position - from.position;
  ASSERT_TRUE(setpoints.go_straight(goal, {0.2, 0.5}));
  double beside_m = 0;
  while (!setpoints.at_rest()) {
    ASSERT_NO_FATAL_FAILURE(advance());
    const Vector3 gone = setpoints.tool().position - from.position;
    beside_m = std::max(beside_m, (gone - gone.dot(way) / way.squaredNorm() * way).norm());
  }
  const robotics::Pose there = setpoints.tool();
  EXPECT_LT(beside_m, 1e-4);
  EXPECT_LT((there.position - goal.position).norm(), 1e-6);
  EXPECT_LT((there.rotation - goal.rotation).norm(), 1e-5);
}

TEST_F(SetpointsTest, GoesStraightWithTheToolAndNotWithTheTip) {
  setpoints.set_tool({Eigen::AngleAxisd{0.7, Vector3::UnitZ()}.toRotationMatrix(), {0.05, 0.1, 0.2}});
  const robotics::Pose from = setpoints.tool();
  robotics::Pose goal = from;
  goal.rotation = Eigen::AngleAxisd{0.5, Vector3::UnitX()} * goal.rotation;
  ASSERT_TRUE(setpoints.go_straight(goal, {0.1, 0.3}));
  double moved_m = 0;
  while (!setpoints.at_rest()) {
    ASSERT_NO_FATAL_FAILURE(advance());
    moved_m = std::max(moved_m, (setpoints.tool().position - from.position).norm());
  }
  EXPECT_LT(moved_m, 1e-4) << "it turns about the tool";
  EXPECT_LT((setpoints.tool().rotation - goal.rotation).norm(), 1e-5);
}

/// As fast as MOVE_L may ask for, and to postures of which some make the joints turn far on a short way.
TEST_F(SetpointsTest, StaysOnItsLineWithinItsAccelerationsHoweverFastItIsToGo) {
  std::mt19937 random{11};
  std::uniform_real_distribution<double> way{-0.4, 0.4};
  for (int i = 0; i < 20; ++i) {
    setpoints.rest(start + JointVector::NullaryExpr(6, [&] { return way(random); }));
    const robotics::Pose goal = setpoints.tool();
    setpoints.rest(start);
    before = start;
    ASSERT_TRUE(setpoints.go_straight(goal, {1, 2}));
    double off_m = 0;
    for (int cycles = 0; !setpoints.at_rest() && cycles < 30'000; ++cycles) {
      ASSERT_NO_FATAL_FAILURE(advance()) << i;
      off_m = std::max(off_m, setpoints.off_line_m());
    }
    ASSERT_EQ(setpoints.line().found(), Line::Found::Way) << i;
    EXPECT_LT(off_m, 5e-4) << i;
    EXPECT_LT((setpoints.tool().position - goal.position).norm(), 1e-6) << i;
  }
}

TEST_F(SetpointsTest, BrakesOnItsLineWithinItsAccelerationsWhereverItIsOnIt) {
  robotics::Pose goal = setpoints.tool();
  goal.position += Vector3{-0.15, 0.25, -0.1};
  for (int cycles = 20; cycles < 1200; cycles += 130) {
    setpoints.rest(start);
    before = start;
    ASSERT_TRUE(setpoints.go_straight(goal, {1, 2}));
    double off_m = 0;
    for (int i = 0; i < cycles && !setpoints.at_rest(); ++i) ASSERT_NO_FATAL_FAILURE(advance());
    const JointVector told = setpoints.braked(), from = setpoints.now().position;
    setpoints.brake();
    for (int i = 0; i < 2000 && !setpoints.at_rest(); ++i) {
      ASSERT_NO_FATAL_FAILURE(advance()) << "braked after " << cycles;
      off_m = std::max(off_m, setpoints.off_line_m());
    }
    ASSERT_TRUE(setpoints.at_rest());
    EXPECT_LT(off_m, 5e-4);
    EXPECT_LE(apart(setpoints.now().position, from), apart(told, from) + last_digits) << "it said where it would rest";
  }
}

/// What it says before it brakes against what it does then: never farther than it said, and what it said too much is little, at each moment of paths, lines and jogs of
/// all speeds. On a line a joint may turn on its way, and be told nearer than it comes: there the joint that goes farthest says it.
TEST_F(SetpointsTest, ToldWhereItWouldRestItRestsThereOrALittleBefore) {
  std::mt19937 random{5};
  const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>{low, high}(random); };
  const auto brake = [&](const char* what, bool each) {
    const JointVector told = setpoints.braked(), from = setpoints.now().position;
    const auto was = setpoints;
    setpoints.brake();
    for (int i = 0; i < 20'000 && !setpoints.at_rest(); ++i) setpoints.advance();
    const JointVector rests = setpoints.now().position;
    setpoints = was;
    const double way = apart(rests, from), said = apart(told, from);
    EXPECT_LE(way, said + last_digits) << what;
    EXPECT_LE(said, 1.35 * way + 0.01) << what;
    for (Eigen::Index i = 0; each && i < 6; ++i)
      EXPECT_LE(std::abs(rests[i] - from[i]), std::abs(told[i] - from[i]) + last_digits) << what << i;
  };
  for (int i = 0; i < 60; ++i) {
    setpoints.rest(start);
    JointVector goal = start + JointVector::NullaryExpr(6, [&] { return any(-0.5, 0.5); });
    const char* what = "jog ";
    if (i % 3 == 0) {
      what = "path ";
      ASSERT_TRUE(setpoints.go(start + (i % 2 == 0 ? 1 : 2) * (goal - start), any(0.2, 1)));
    } else if (i % 3 == 1) {
      what = "line ";
      setpoints.rest(goal);
      const robotics::Pose there = setpoints.tool();
      setpoints.rest(start);
      const double speed = any(0.2, 1);
      ASSERT_TRUE(setpoints.go_straight(there, {speed, 2 * speed}));
    } else {
      setpoints.jog(JointVector{4 * (goal - start)});
    }
    for (int cycles = 0; cycles < 700 && (cycles < 5 || !setpoints.at_rest()); ++cycles) {
      if (cycles % 67 == 66) brake(what, i % 3 != 1);
      setpoints.advance();
    }
  }
}

TEST_F(SetpointsTest, StandsWhereTheArmCannotFollowALineAndSaysHowFarItCould) {
  robotics::Pose goal = setpoints.tool();
  goal.position += Vector3{0, 0, 3};
  ASSERT_TRUE(setpoints.go_straight(goal, {0.5, 0.5}));
  for (int i = 0; i < 300 && !setpoints.at_rest(); ++i) ASSERT_NO_FATAL_FAILURE(advance());
  EXPECT_TRUE(setpoints.at_rest());
  EXPECT_EQ(setpoints.now().position, start);
  EXPECT_EQ(setpoints.line().found(), Line::Found::Nothing);
  EXPECT_EQ(setpoints.line().joint_in_the_way(), std::nullopt) << "it is stretched out";
  EXPECT_GT(setpoints.line().free_m(), 0.05);
  EXPECT_LT(setpoints.line().free_m(), 1.5);
}

TEST_F(SetpointsTest, SaysWhichJointsRangeALineLeadsOutOf) {
  start[5] = before[5] = bounds[5].highest - 0.3;
  setpoints.rest(start);
  robotics::Pose goal = setpoints.tool();
  goal.rotation = goal.rotation * Eigen::AngleAxisd{1.5, Vector3::UnitY()};  // the axis of the last joint
  ASSERT_TRUE(setpoints.go_straight(goal, {0.1, 0.5}));
  for (int i = 0; i < 300 && !setpoints.at_rest(); ++i) ASSERT_NO_FATAL_FAILURE(advance());
  EXPECT_EQ(setpoints.now().position, start);
  EXPECT_EQ(setpoints.line().found(), Line::Found::Nothing);
  EXPECT_EQ(setpoints.line().joint_in_the_way(), 5);
}

TEST_F(SetpointsTest, JogsEachJointToTheEndOfItsRangeAndNotBeyond) {
  for (const double way : {1.0, -1.0}) {
    setpoints.jog(JointVector{way * 5 * JointVector::Ones(6)});
    for (int i = 0; i < 8000; ++i) ASSERT_NO_FATAL_FAILURE(advance());
    for (std::size_t joint = 0; joint < 6; ++joint) {
      const double end = way > 0 ? bounds[joint].highest : bounds[joint].lowest;
      EXPECT_NEAR(setpoints.now().position[static_cast<Eigen::Index>(joint)], end, 0.01) << joint;
    }
    setpoints.brake();
    ASSERT_NO_FATAL_FAILURE(finish());
  }
}

TEST_F(SetpointsTest, JogsTheToolAlongAnAxis) {
  const robotics::Pose from = setpoints.tool();
  Vector6 twist = Vector6::Zero();
  twist[5] = 0.1;
  setpoints.jog(twist);
  for (int i = 0; i < 1000; ++i) ASSERT_NO_FATAL_FAILURE(advance());
  setpoints.brake();
  ASSERT_NO_FATAL_FAILURE(finish());
  const Vector3 gone = setpoints.tool().position - from.position;
  EXPECT_NEAR(gone.z(), 0.1, 0.01);
  EXPECT_LT(gone.head<2>().norm(), 0.002);
}

/// Each joint by another way: up to the goal and on to a second one, so that the way back has a corner.
TEST_F(SetpointsTest, GoesBackByTheWayItCameSoFarAsItIsAsked) {
  setpoints.begin(start);
  JointVector corner = start;
  corner[0] += 0.3;
  corner[3] -= 0.2;
  JointVector goal = corner;
  goal[1] += 0.1;
  std::vector<JointVector> came;
  for (const JointVector& next : {corner, goal}) {
    ASSERT_TRUE(setpoints.go(next, 1));
    while (!setpoints.at_rest()) {
      came.push_back(setpoints.now().position);
      ASSERT_NO_FATAL_FAILURE(advance());
    }
  }
  setpoints.retract(goal, JointVector::Zero(6), 0.25);
  double off = 0;
  for (int cycles = 0; !setpoints.at_rest() && cycles < 20'000; ++cycles) {
    // No faster than a quarter of its velocities, and braked within its accelerations.
    ASSERT_NO_FATAL_FAILURE(advance());
    ASSERT_LE(std::abs(setpoints.now().velocity[0]), 0.26 * bounds[0].motion.velocity);
    double nearest = HUGE_VAL;
    for (const JointVector& place : came) nearest = std::min(nearest, apart(place, setpoints.now().position));
    off = std::max(off, nearest);
  }
  ASSERT_TRUE(setpoints.at_rest());
  EXPECT_LT(off, 2.5 * Trail::spacing) << "it cuts the corner, within its accelerations";
  // 0.1 to the corner and 0.15 of 0.3 on from it.
  EXPECT_LT(apart(setpoints.now().position, corner + 0.5 * (start - corner)), 2e-3);
  // Asked for more than there is, it ends where it began.
  setpoints.retract(setpoints.now().position, JointVector::Zero(6), 5);
  ASSERT_NO_FATAL_FAILURE(finish());
  EXPECT_LT(apart(setpoints.now().position, start), 2e-3);
}

TEST_F(SetpointsTest, GoesBackFromAMotionAndStandsWhereThereIsNoWay) {
  setpoints.begin(start);
  JointVector velocity = JointVector::Zero(6);
  velocity[1] = 1;
  setpoints.retract(start, velocity, 0.2);
  before = start;
  for (int cycles = 0; !setpoints.at_rest() && cycles < 20'000; ++cycles) ASSERT_NO_FATAL_FAILURE(advance(5));
  ASSERT_TRUE(setpoints.at_rest());
  EXPECT_LT(apart(setpoints.now().position, start), 0.05);
}

/// With the share of the velocities, and for as long, as they were made for.
TEST_F(SetpointsTest, GoBackByWhereSomebodyElseTookThem) {
  for (const double longest_s : {60.0, 0.1}) {
    Setpoints taken{
        model, model.find_frame("tool").value(), bounds, cycle_s, {.speed_share = 0.5, .longest_s = longest_s}};
    taken.begin(start);
    JointVector there = start;
    for (; there[0] < 0.7; there[0] += 1e-3) taken.pass(there);
    EXPECT_TRUE(taken.at_rest());
    EXPECT_LT((taken.now().position - there).cwiseAbs().maxCoeff(), 2e-3);
    taken.retract(taken.now().position, JointVector::Zero(6), 5);
    double fastest = 0;
    for (int i = 0; i < 10'000 && !taken.at_rest(); ++i)
      fastest = std::max(fastest, std::abs(taken.advance().velocity[0]));
    EXPECT_EQ(taken.retreated(), longest_s > 1);
    if (longest_s < 1) continue;
    EXPECT_LT((taken.now().position - start).cwiseAbs().maxCoeff(), 2e-3);
    EXPECT_NEAR(fastest, 0.5 * bounds[0].motion.velocity, 0.1 * bounds[0].motion.velocity);
  }
}

}  // namespace
}  // namespace hirosco::robot_arm
