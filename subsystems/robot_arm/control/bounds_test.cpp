// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/bounds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/control/watch.hpp"

/// What a joint may do, by its URDF file.
namespace hirosco::robot_arm {
namespace {

struct OneJoint {
  double velocity{3}, effort{10}, damping{0}, friction{0};
};
[[nodiscard]] std::expected<std::vector<JointBounds>, std::string> bounds_with(const OneJoint& its) {
  robotics::JointDescription joint;
  joint.name = "wrist";
  joint.damping = its.damping;
  joint.friction = its.friction;
  joint.limits = {.lower = -1, .upper = 2, .velocity = its.velocity, .effort = its.effort};
  joint.moved = {.mass = 1, .about_centre = 0.01 * robotics::Matrix3::Identity()};
  robotics::ModelDescription description;
  description.joints.push_back(joint);
  return robot_arm::bounds_of(robotics::Model::make(description).value());
}

TEST(BoundsOf, AreThoseOfTheFile) {
  const auto bounds = bounds_with({.damping = 1, .friction = 1});
  ASSERT_TRUE(bounds);
  EXPECT_EQ(bounds->at(0).lowest, -1);
  EXPECT_EQ(bounds->at(0).highest, 2);
  EXPECT_EQ(bounds->at(0).effort, 10);
  EXPECT_EQ(bounds->at(0).motion.velocity, 3) << "half of 9 N m drives it at 4.5 rad/s";
}

TEST(BoundsOf, LeadNoJointFasterThanHalfOfItsDriveKeepsIt) {
  const auto bounds = bounds_with({.velocity = 100, .effort = 0.45, .damping = 1});
  ASSERT_TRUE(bounds);
  EXPECT_EQ(bounds->at(0).motion.velocity, 0.225);
  EXPECT_EQ(bounds_with({.velocity = 100, .effort = 3, .damping = 2, .friction = 1})->at(0).motion.velocity, 0.5);
  EXPECT_EQ(bounds_with({.velocity = 7, .effort = 3, .damping = 2, .friction = 3})->at(0).motion.velocity, 7)
      << "it reaches none: hirosco new robot refuses it";
}

TEST(BoundsOf, LetWhoIsPushedBeAsFastAsTheFileSays) {
  const auto bounds = bounds_with({.velocity = 2, .effort = 1, .damping = 1});
  ASSERT_TRUE(bounds);
  const JointVector zero = JointVector::Zero(1);
  for (const auto& [speed, stops] : {std::pair{2.1, false}, {2.3, true}}) {
    Watch watch;
    const Measured pushed{zero, JointVector::Constant(1, speed), zero};
    EXPECT_FALSE(watch.update(pushed, nullptr, *bounds, {})) << speed;
    EXPECT_EQ(watch.update(pushed, nullptr, *bounds, {}).has_value(), stops) << speed;
  }
}

TEST(BoundsOf, NamesTheJointThatLacksALimit) {
  const auto none = bounds_with({.effort = 0});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error(), ::testing::HasSubstr("joint 'wrist'"));
}

}  // namespace
}  // namespace hirosco::robot_arm
