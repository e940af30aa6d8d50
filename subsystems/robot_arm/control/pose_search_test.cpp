// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/pose_search.hpp"

#include <gtest/gtest.h>

#include <random>

#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

using Found = PoseSearch::Found;

struct PoseSearchTest : ::testing::Test {
  robotics::Model model = testing::model_of(testing::six_axes);
  std::vector<JointBounds> bounds = testing::bounds_of(model);
  robotics::FrameId tip = model.find_frame("tool").value();
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  PoseSearch search{model, tip, bounds};
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});

  robotics::Pose tip_at(const JointVector& q) {
    robotics::State state;
    state.q = q;
    state.qd = JointVector::Zero(6);
    dynamics.update(state);
    return dynamics.frame_pose(tip);
  }
  Found looked_for(const robotics::Pose& pose, int& steps) {
    search.begin(pose, start);
    Found found = Found::NotYet;
    for (steps = 0; found == Found::NotYet && steps < 60; ++steps) found = search.step();
    return found;
  }
};

TEST_F(PoseSearchTest, FindsThePostureOfAPoseNearbyAndTheSameOneEachTime) {
  std::mt19937 random{7};
  std::uniform_real_distribution<double> way{-0.2, 0.2};
  for (int i = 0; i < 50; ++i) {
    const robotics::Pose wanted = tip_at(start + JointVector::NullaryExpr(6, [&] { return way(random); }));
    int steps = 0;
    ASSERT_EQ(looked_for(wanted, steps), Found::Posture) << i;
    EXPECT_FALSE(search.singular()) << i;
    const JointVector first = search.posture();
    EXPECT_LT((tip_at(first).position - wanted.position).norm(), 1e-6);
    EXPECT_LT((tip_at(first).rotation - wanted.rotation).norm(), 1e-6);
    for (std::size_t joint = 0; joint < 6; ++joint) {
      EXPECT_GE(first[static_cast<Eigen::Index>(joint)], bounds[joint].lowest);
      EXPECT_LE(first[static_cast<Eigen::Index>(joint)], bounds[joint].highest);
    }
    ASSERT_EQ(looked_for(wanted, steps), Found::Posture);
    EXPECT_EQ(search.posture(), first);
  }
}

TEST_F(PoseSearchTest, EndsWithin50CyclesWhereThereIsNone) {
  robotics::Pose far = tip_at(start);
  far.position *= 2.5;
  int steps = 0;
  EXPECT_EQ(looked_for(far, steps), Found::Nothing);
  EXPECT_EQ(steps, 50);
  EXPECT_EQ(search.joint_at_its_end(), std::nullopt) << "it is stretched out";
  EXPECT_GT(search.off_m(), 0.5);
}

TEST_F(PoseSearchTest, SaysWhoseRangeEndsBeforeThePose) {
  robotics::Pose turned = tip_at(start);
  turned.rotation = turned.rotation * Eigen::AngleAxisd{bounds[5].highest - start[5] + 0.05, Vector3::UnitY()};
  int steps = 0;
  EXPECT_EQ(looked_for(turned, steps), Found::Nothing);
  EXPECT_EQ(search.joint_at_its_end(), 5);
}

/// The arm of six whose wrist does not bend. Its Jacobian is damped wherever it is: whoever drew it to where it stands would keep it off each pose that is farther away.
TEST(PoseSearchOfFiveJoints, FindsEveryPoseThatTheyHaveBeenIn) {
  std::string text = descriptor::file_system()(testing::six_axes).value();
  const std::string bend = R"(<joint name="bend" type="revolute">)";
  ASSERT_NE(text.find(bend), std::string::npos);
  text.replace(text.find(bend), bend.size(), R"(<joint name="bend" type="fixed">)");
  const auto reading = robotics::urdf::read(testing::six_axes, text);
  ASSERT_TRUE(reading.value);
  const robotics::Model model = robotics::Model::make(robotics::urdf::describe(*reading.value)).value();
  ASSERT_EQ(model.joint_count(), 5);
  const std::vector<JointBounds> bounds = testing::bounds_of(model);
  const robotics::FrameId tip = model.find_frame("tool").value();
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  const JointVector start = vector_of(std::array{0.2, 0.5, 1.2, 0.7, 0.1});
  PoseSearch search{model, tip, bounds};
  std::mt19937 random{7};
  std::uniform_real_distribution<double> way{-0.4, 0.4};
  for (int i = 0; i < 20; ++i) {
    const JointVector there = start + JointVector::NullaryExpr(5, [&] { return way(random); });
    dynamics.update({.q = there, .qd = JointVector::Zero(5)});
    const robotics::Pose wanted = dynamics.frame_pose(tip);
    for (const PreferredPosture& preferred : {PreferredPosture{}, PreferredPosture{start + 0.5 * (there - start), 1}}) {
      search.begin(wanted, start, preferred);
      Found found = Found::NotYet;
      for (int step = 0; found == Found::NotYet && step < 50; ++step) found = search.step();
      EXPECT_EQ(found, Found::Posture) << i;
      EXPECT_LT((search.posture() - there).cwiseAbs().maxCoeff(), 1e-3) << i;
    }
  }
}

/// The axes of bend and twist fall together where roll is 0.
TEST_F(PoseSearchTest, SaysThatAPostureIsSingular) {
  JointVector parallel = start;
  parallel[4] = 0;
  int steps = 0;
  static_cast<void>(looked_for(tip_at(parallel), steps));
  EXPECT_TRUE(search.singular());
}

}  // namespace
}  // namespace hirosco::robot_arm
