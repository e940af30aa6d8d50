// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/preferred_posture.hpp"

#include <gtest/gtest.h>

#include <random>

#include "subsystems/robot_arm/control/pose_search.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// An arm of seven joints has a whole curve of postures for a pose of its tool: which of them it takes is said.
namespace hirosco::robot_arm {
namespace {

using Found = PoseSearch::Found;

struct PreferredPostureTest : ::testing::Test {
  static constexpr double cycle_s = 0.001;
  robotics::Model model = testing::model_of(HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/floating_arm.urdf");
  std::vector<JointBounds> bounds = testing::bounds_of(model);
  robotics::FrameId tip = model.find_frame("tool").value();
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  PoseSearch search{model, tip, bounds};
  Setpoints setpoints{model, tip, bounds, cycle_s};
  JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});

  robotics::Pose tip_at(const JointVector& q) {
    dynamics.update({.q = q, .qd = JointVector::Zero(7)});
    return dynamics.frame_pose(tip);
  }
  /// How the joints move there while the tool stands.
  JointVector self_motion(const JointVector& q) {
    dynamics.update({.q = q, .qd = JointVector::Zero(7)});
    Jacobian jacobian;
    dynamics.jacobian(tip, jacobian);
    const Eigen::MatrixXd all = jacobian;
    const Eigen::VectorXd free = all.fullPivLu().kernel().col(0);
    return JointVector{free.normalized()};
  }
  /// With its tool in the same pose, and its elbow swung.
  JointVector swung() {
    EXPECT_EQ(looked_for(tip_at(ready), ready, {ready + 0.6 * self_motion(ready), 1}), Found::Posture);
    return search.posture();
  }
  Found looked_for(const robotics::Pose& pose, const JointVector& from, const PreferredPosture& preferred) {
    search.begin(pose, from, preferred);
    Found found = Found::NotYet;
    for (steps = 0; found == Found::NotYet && steps < 110; ++steps) found = search.step();
    return found;
  }
  /// Along a line, and within all that joints may do. How far the tool was beside it at most.
  double go(const robotics::Pose& goal, const PreferredPosture& preferred) {
    const robotics::Pose from = setpoints.tool();
    const Vector3 way = goal.position - from.position;
    EXPECT_TRUE(setpoints.go_straight(goal, {0.02, 0.1}, preferred));
    double beside_m = 0;
    for (int i = 0; i < 60'000 && !setpoints.at_rest(); ++i) {
      const JointVector before = setpoints.now().velocity;
      const Setpoint& now = setpoints.advance();
      for (std::size_t joint = 0; joint < 7; ++joint) {
        const auto k = static_cast<Eigen::Index>(joint);
        const auto& its = bounds[joint].motion;
        EXPECT_LE(std::abs(now.velocity[k]), its.velocity * (1 + 1e-9));
        EXPECT_LE(std::abs(now.velocity[k] - before[k]), its.acceleration * cycle_s * (1 + 1e-6) + 1e-9);
      }
      const Vector3 gone = setpoints.tool().position - from.position;
      beside_m = std::max(beside_m, (gone - gone.dot(way) / way.squaredNorm() * way).norm());
    }
    EXPECT_TRUE(setpoints.at_rest());
    EXPECT_EQ(setpoints.line().found(), Line::Found::Way);
    EXPECT_LT((setpoints.tool().position - goal.position).norm(), 1e-6);
    EXPECT_LT((setpoints.tool().rotation - goal.rotation).norm(), 1e-5);
    return beside_m;
  }
  int steps{0};
};

TEST_F(PreferredPostureTest, IsTheOneOfAPoseThatItHasWhereverTheArmStands) {
  const JointVector from = swung();
  ASSERT_GT((from - ready).cwiseAbs().maxCoeff(), 0.3);
  const robotics::Pose same = tip_at(from);
  ASSERT_EQ(looked_for(same, from, {ready, 1}), Found::Posture);
  EXPECT_LT((search.posture() - ready).cwiseAbs().maxCoeff(), 1e-3) << "with its tool where it is";
  ASSERT_EQ(looked_for(same, from, {}), Found::Posture);
  EXPECT_EQ(search.posture(), from) << "and without it, it stays";
}

TEST_F(PreferredPostureTest, HasTheSamePostureForAPoseFromWhereverItIsLookedFor) {
  std::mt19937 random{5};
  std::uniform_real_distribution<double> near{-0.3, 0.3};
  const JointVector elsewhere = swung();
  for (int i = 0; i < 20; ++i) {
    const robotics::Pose wanted = tip_at(ready + JointVector::NullaryExpr(7, [&] { return near(random); }));
    ASSERT_EQ(looked_for(wanted, ready, {ready, 1}), Found::Posture) << i;
    EXPECT_LT(steps, 50) << i;
    const JointVector first = search.posture();
    ASSERT_EQ(looked_for(wanted, elsewhere, {ready, 1}), Found::Posture) << i;
    EXPECT_EQ(search.posture(), first) << i;
    EXPECT_LT((tip_at(first).position - wanted.position).norm(), 1e-6);
    EXPECT_LT((tip_at(first).rotation - wanted.rotation).norm(), 1e-6);
    // Of all that have the tool there none is nearer to it: what is left is no self-motion.
    EXPECT_NEAR(self_motion(first).dot(ready - first), 0, 1e-3) << i;
  }
}

/// The tool stays on its line as it does without it; its joints come to the posture on the way.
TEST_F(PreferredPostureTest, IsComeToAlongALineWhichTheToolDoesNotLeave) {
  const JointVector from = swung();
  robotics::Pose goal = tip_at(from);
  goal.position += Vector3{-0.1, 0.15, -0.1};
  ASSERT_EQ(looked_for(goal, from, {ready, 1}), Found::Posture);
  const JointVector nearest = search.posture();
  setpoints.rest(from);
  EXPECT_LT(go(goal, {}), 1e-4);
  EXPECT_GT((setpoints.now().position - nearest).cwiseAbs().maxCoeff(), 0.2) << "without it, it is elsewhere";
  setpoints.rest(from);
  EXPECT_LT(go(goal, {ready, 0.5}), 1e-4);
  EXPECT_LT((setpoints.now().position - nearest).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT((setpoints.line().posture() - setpoints.now().position).cwiseAbs().maxCoeff(), 0.01)
      << "which was foreseen while it stood";
}

/// As fast as its gain may be joints would go there much faster than they may: the line goes slower, and is not given up.
TEST_F(PreferredPostureTest, IsComeToWithinAllLimitsHoweverFastItIsWanted) {
  const JointVector from = swung();
  robotics::Pose goal = tip_at(from);
  goal.position += Vector3{-0.1, 0.15, -0.1};
  ASSERT_EQ(looked_for(goal, from, {ready, 1}), Found::Posture);
  const JointVector nearest = search.posture();
  setpoints.rest(from);
  constexpr double most_gain_per_s = 5, given_up_m = 0.002;
  EXPECT_LT(go(goal, {ready, most_gain_per_s}), given_up_m);
  EXPECT_LT((setpoints.now().position - nearest).cwiseAbs().maxCoeff(), 0.02);
}

TEST_F(PreferredPostureTest, OfAPoseOutOfReachIsNoneWithinTwiceAsManyCycles) {
  robotics::Pose far = tip_at(ready);
  far.position *= 2.5;
  EXPECT_EQ(looked_for(far, ready, {ready, 1}), Found::Nothing);
  EXPECT_EQ(steps, 100);
}

}  // namespace
}  // namespace hirosco::robot_arm
