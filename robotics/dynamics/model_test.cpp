// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "robotics/dynamics/testing/robots.hpp"

namespace hirosco::robotics {
namespace {

using testing::ball;
using testing::joint;

[[nodiscard]] ModelDescription two_sliders() {
  ModelDescription description;
  description.joints = {joint(JointKind::Prismatic, Vector3::UnitX(), {0, 0, 0}, ball(1, {0, 0, 0})),
                        joint(JointKind::Prismatic, Vector3::UnitY(), {0, 0, 0}, ball(2, {0, 0, 0}), 0)};
  return description;
}

TEST(Model, TakesJointsInAnyOrderAndNumbersCoordinatesInTheGivenOne) {
  auto description = two_sliders();
  description.joints[0].parent = 1;
  description.joints[1].parent.reset();
  description.joints[0].name = "FIRST";
  const auto model = Model::make(description);
  ASSERT_TRUE(model);
  EXPECT_EQ(model->joints()[0].name, "FIRST");
  EXPECT_EQ(model->bodies()[1].coordinate, 1);
  EXPECT_EQ(model->bodies()[2].parent, 1U);
}

TEST(Model, RefusesWhatIsNoRobotAndSaysWhichJointIsWrong) {
  const auto refused = [](auto change) {
    auto description = two_sliders();
    change(description.joints[1]);
    const auto model = Model::make(description);
    return !model && model.error().value == 1;
  };
  EXPECT_TRUE(refused([](JointDescription& it) { it.axis = {0, 0, 2}; }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.axis = Vector3::Zero(); }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.moved.mass = -1; }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.moved.about_centre.diagonal() = Vector3{1, 1, -1}; }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.moved.about_centre(0, 1) = 1; }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.damping = -0.1; }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.friction = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.limits.upper = std::numeric_limits<double>::infinity(); }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.parent = 2; }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.placement.rotation *= 2; }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.placement.rotation = -Matrix3::Identity(); }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.mimic = Mimic{5, 1, 0}; }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.mimic = Mimic{0, 0, 0}; }));
  EXPECT_TRUE(refused([](JointDescription& it) { it.mimic = Mimic{1, 1, 0}; }));
  EXPECT_FALSE(refused([](JointDescription&) {}));
}

TEST(Model, RefusesCirclesAndNoJoints) {
  auto description = two_sliders();
  description.joints[0].parent = 1;
  EXPECT_FALSE(Model::make(description));
  EXPECT_FALSE(Model::make({}));
}

TEST(Model, HasRoomForSixteenJointsAndAsManyThatMimicThem) {
  ModelDescription description;
  for (std::size_t i = 0; i < max_joints; ++i)
    description.joints.push_back(joint(JointKind::Revolute, Vector3::UnitZ(), {1, 0, 0}, ball(1, {1, 0, 0})));
  EXPECT_TRUE(Model::make(description));
  auto more = description;
  more.joints.push_back(more.joints[0]);
  const auto refused = Model::make(more);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
  for (std::size_t i = 0; i < max_joints; ++i) {
    description.joints.push_back(description.joints[0]);
    description.joints.back().mimic = Mimic{i, 2, 0};
  }
  ASSERT_TRUE(Model::make(description));
  EXPECT_EQ(Model::make(description)->joint_count(), max_joints);
  description.joints.push_back(description.joints.back());
  EXPECT_FALSE(Model::make(description));
}

TEST(Model, KeepsMimicJointsWithinTheirLimitsByTheJointThatTheyFollow) {
  auto description = two_sliders();
  description.joints[0].limits = {-1, 1, 2, 5, 3, {}};
  description.joints[1].mimic = Mimic{0, -2, 0.5};
  description.joints[1].limits = {-0.5, 3, 1, 5, 8, 30};
  const auto model = testing::make(description);
  const JointLimits& limits = model.joints()[0].limits;
  // -0.5 <= 0.5 - 2 q <= 3 is -1.25 <= q <= 0.5, and |2 qd| <= 1.
  EXPECT_DOUBLE_EQ(limits.lower.value(), -1);
  EXPECT_DOUBLE_EQ(limits.upper.value(), 0.5);
  EXPECT_DOUBLE_EQ(limits.velocity.value(), 0.5);
  EXPECT_DOUBLE_EQ(limits.effort.value(), 5);
  EXPECT_DOUBLE_EQ(limits.acceleration.value(), 3) << "8 / 2 is more";
  EXPECT_DOUBLE_EQ(limits.jerk.value(), 15);
}

TEST(Model, FindsFramesByName) {
  auto description = two_sliders();
  description.frames = {{"one", {}, {}}, {"other", 1, {}}};
  const auto model = testing::make(description);
  EXPECT_EQ(model.find_frame("other").value().index, 1U);
  EXPECT_EQ(model.find_frame("nobody").error().code, ErrorCode::NotFound);
  description.frames[0].joint = 2;
  EXPECT_FALSE(Model::make(description));
}

TEST(Inertias, OfTwoBodiesAddUpAboutTheirCommonCentre) {
  const Inertia sum = ball(1, {0, 0, 0}, 0.5) + ball(3, {4, 0, 0}, 0.5);
  EXPECT_DOUBLE_EQ(sum.mass, 4);
  EXPECT_DOUBLE_EQ(sum.centre.x(), 3);
  // The reduced mass 3/4 at a distance of 4.
  EXPECT_DOUBLE_EQ(sum.about_centre(0, 0), 1);
  EXPECT_DOUBLE_EQ(sum.about_centre(1, 1), 13);
  EXPECT_DOUBLE_EQ(sum.about_centre(2, 2), 13);
}

}  // namespace
}  // namespace hirosco::robotics
