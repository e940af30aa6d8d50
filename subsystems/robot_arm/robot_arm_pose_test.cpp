// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/ball.hpp"
#include "subsystems/robot_arm/testing/flown.hpp"

/// Poses of the tool as goals: judged before the arm moves.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct RobotArmPose : ::testing::Test {
  Flown flown{6, std::string{folder} + "robot_arm.urdf"};
  robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector beside = vector_of(std::array{0.6, 0.3, 0.9, -0.3, 1.0, 0.6});
  const std::string done = "1 3 5:0001 7";

  void SetUp() override {
    flown.plant.place(start);
    flown.operate();
  }
  [[nodiscard]] robotics::Pose flange_at(const JointVector& q) {
    dynamics.update({.q = q, .qd = JointVector::Zero(6)});
    return dynamics.frame_pose(flown.model.find_frame("tool").value());
  }
  [[nodiscard]] robotics::Pose flange() { return flange_at(flown.plant.measured().position); }
  [[nodiscard]] static double turned(const robotics::Pose& from, const robotics::Pose& to) {
    return Eigen::AngleAxisd{robotics::Matrix3{from.rotation.transpose() * to.rotation}}.angle();
  }
  hirosco::testing::Sent ask(const char* function, const robotics::Pose& pose, std::vector<double> speeds) {
    const robotics::Quaternion wxyz{pose.rotation};
    std::vector<double> numbers{pose.position.x(), pose.position.y(), pose.position.z(), wxyz.w(),
                                wxyz.x(),          wxyz.y(),          wxyz.z()};
    numbers.insert(numbers.end(), speeds.begin(), speeds.end());
    return flown.ask(function, numbers);
  }
  hirosco::testing::Sent move_p(const robotics::Pose& pose) { return ask("MOVE_P", pose, {1}); }
  [[nodiscard]] static std::string hex_of(const std::string& words) {
    return testing::hex(std::as_bytes(std::span{words}));
  }
  void keep_out(const robotics::Vector3& there) { robot_arm::testing::keep_out_ball(flown, there); }
};

TEST_F(RobotArmPose, IsReachedWithinAMillimetreAndAMilliradianAndInTheSamePostureEachTime) {
  const robotics::Pose wanted = flange_at(beside);
  std::vector<JointVector> postures;
  for (int i = 0; i < 2; ++i) {
    const auto there = move_p(wanted);
    flown.finish(there);
    EXPECT_EQ(flown.rig.outcome(there), done);
    EXPECT_LE((flange().position - wanted.position).norm(), 1e-3);
    flown.cycle(1000);
    EXPECT_LE(turned(flange(), wanted), 1e-3);
    postures.push_back(flown.plant.measured().position);
    const auto back = flown.move_j(start);
    flown.finish(back);
    EXPECT_EQ(flown.rig.outcome(back), done);
  }
  EXPECT_LT((postures[0] - postures[1]).cwiseAbs().maxCoeff(), 1e-3);
}

TEST_F(RobotArmPose, WhereItIsAlreadyIsDoneAtOnce) {
  const auto request = move_p(flange_at(start));
  flown.cycle(100);
  EXPECT_EQ(flown.rig.outcome(request), done);
  EXPECT_LT(flown.off(start), 1e-3);
}

/// What is in the way of a pose, how it is told, and in which words.
TEST_F(RobotArmPose, ThatCannotBeTakenIsToldWithItsReasonAndNothingMoves) {
  robotics::Pose far = flange_at(start), beyond = flange_at(start);
  far.position *= 2.5;
  beyond.rotation = beyond.rotation * Eigen::AngleAxisd{3.05, robotics::Vector3::UnitY()};  // twist would be at 3.15
  JointVector parallel = start;
  parallel[4] = 0;  // the axes of bend and twist fall together
  for (const auto& [wanted, code, words] :
       {std::tuple{far, "800e", "as near as it comes"}, std::tuple{beyond, "8002", "ends the range of joint"},
        std::tuple{flange_at(parallel), "800f", "a singular posture"}}) {
    const auto request = move_p(wanted);
    flown.cycle(60);
    EXPECT_THAT(flown.rig.outcome(request), StartsWith(std::string{"1 3 8:"} + code)) << words;
    EXPECT_THAT(flown.rig.outcome(request), HasSubstr(hex_of(words)));
    flown.cycle(200);
    EXPECT_LT(flown.off(start), 1e-3) << words;
  }
  const auto nowhere = flown.ask("MOVE_P", {0.5, 0, 0.5, 0, 0, 0, 0, 1});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(nowhere), StartsWith("1 4:8009"));
}

TEST_F(RobotArmPose, InWhichItWouldBeTooNearIsToldWithThePairAndNothingMoves) {
  keep_out(flange_at(beside).position);
  const auto request = move_p(flange_at(beside));
  flown.cycle(60);
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8:800a"));
  EXPECT_THAT(flown.rig.outcome(request), HasSubstr(hex_of(" and ")));
  flown.cycle(200);
  EXPECT_LT(flown.off(start), 1e-3);
}

/// The line is walked along before the arm goes: whatever ends it is told while the arm stands.
TEST_F(RobotArmPose, AtTheEndOfALineThatCannotBeFollowedIsToldWithItsReasonAndNothingMoves) {
  robotics::Pose far = flange_at(start), beyond = flange_at(start);
  far.position *= 2.5;
  beyond.rotation = beyond.rotation * Eigen::AngleAxisd{3.05, robotics::Vector3::UnitY()};  // twist would be at 3.15
  for (const auto& [wanted, words] :
       {std::pair{far, "it leads out of reach, after mm"}, std::pair{beyond, "ends the range of joint"}}) {
    const auto request = ask("MOVE_L", wanted, {0.25, 0.5});
    flown.cycle(400);
    EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8:8008")) << words;
    EXPECT_THAT(flown.rig.outcome(request), HasSubstr(hex_of(words)));
    EXPECT_LT(flown.off(start), 1e-3) << words;
  }
  robotics::Pose wanted = flange_at(start);
  wanted.position += robotics::Vector3{-0.2, 0.15, 0.1};
  keep_out(wanted.position);
  const auto request = ask("MOVE_L", wanted, {0.25, 0.5});
  flown.cycle(150);
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8:800a"));
  EXPECT_THAT(flown.rig.outcome(request), HasSubstr(hex_of(" and ")));
  EXPECT_EQ(flown.rig.events(1026), 0) << "it was not stopped on its way";
  EXPECT_LT(flown.off(start), 1e-3);
  JointVector away = start;  // "beside" has the hand 3 mm from the ball, and is refused with reason
  away[0] -= 0.4;
  const auto next = flown.move_j(away);
  flown.finish(next);
  EXPECT_EQ(flown.rig.outcome(next), done) << "it stood, and nothing is left of the line";
}

/// A tool beside the flange and turned against it: what poses, lines and TOOL are of.
TEST_F(RobotArmPose, IsThatOfTheToolAsItIsPlacedAndTurned) {
  const robotics::Pose in_flange{Eigen::AngleAxisd{0.5, robotics::Vector3::UnitX()}.toRotationMatrix(), {0.02, 0.1, 0}};
  const auto set = ask("SET_TOOL", in_flange, {});
  flown.cycle(3);
  ASSERT_EQ(flown.rig.outcome(set), "1 3 7");
  const robotics::Pose wanted = flange_at(beside) * in_flange;
  const auto there = move_p(wanted);
  flown.finish(there);
  EXPECT_EQ(flown.rig.outcome(there), done);
  flown.cycle(1000);
  EXPECT_LE(((flange() * in_flange).position - wanted.position).norm(), 1e-3);
  EXPECT_LE(turned(flange() * in_flange, wanted), 1e-3);
  robotics::Pose lower = wanted;
  lower.position.z() -= 0.05;
  const auto down = ask("MOVE_L", lower, {0.1, 0.5});
  flown.finish(down);
  EXPECT_EQ(flown.rig.outcome(down), done);
  flown.cycle(1000);
  EXPECT_LE(((flange() * in_flange).position - lower.position).norm(), 1e-3);
  EXPECT_LE(turned(flange() * in_flange, lower), 1e-3) << "it was turned as the tool all the way";
}

TEST_F(RobotArmPose, OfAToolWithoutAnOrientationIsTurnedAsTheFlange) {
  const auto none = flown.ask("SET_TOOL", {0, 0.1, 0, 0.1, 0, 0, 0});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(none), StartsWith("1 4:8009"));
  const auto set = flown.rig.call_with("SET_TOOL", {Value{0.0}, Value{0.1}, Value{0.0}});
  flown.cycle(3);
  ASSERT_EQ(flown.rig.outcome(set), "1 3 7");
  const robotics::Pose wanted = flange_at(beside) * robotics::Pose{robotics::Matrix3::Identity(), {0, 0.1, 0}};
  const auto there = move_p(wanted);
  flown.finish(there);
  EXPECT_EQ(flown.rig.outcome(there), done);
  EXPECT_LE(flown.off(beside), 0.01);
}

TEST_F(RobotArmPose, ThatWasComeToIsLeftByTheWayItCameAndNowhereElse) {
  const auto none = flown.ask("RETREAT", {0.1});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(none), StartsWith("1 4:8009")) << "it has not moved yet";
  JointVector corner = start, goal = start;
  corner[0] += 0.2;
  goal[0] += 0.2;
  goal[5] += 0.2;
  for (const JointVector& next : {corner, goal}) {
    const auto there = flown.move_j(next);
    flown.finish(there);
    ASSERT_EQ(flown.rig.outcome(there), done);
  }
  const auto half = flown.ask("RETREAT", {0.2});
  flown.finish(half);
  EXPECT_EQ(flown.rig.outcome(half), "1 3 7");
  EXPECT_LT(flown.off(corner), 0.015) << "within a place of the trail";
  EXPECT_EQ(flown.rig.events(1027), 1);
  const auto all = flown.ask("RETREAT", {1});
  flown.finish(all);
  EXPECT_EQ(flown.rig.outcome(all), "1 3 7");
  EXPECT_LT(flown.off(start), 0.015);
  const auto farther = flown.ask("RETREAT", {0.1});
  flown.finish(farther);
  EXPECT_LT(flown.off(start), 0.015) << "there is no more of it";
}

TEST_F(RobotArmPose, ThatIsLookedForIsGivenUpByHold) {
  robotics::Pose far = flange_at(start);
  far.position *= 2.5;
  const auto request = move_p(far);
  flown.cycle(10);
  EXPECT_EQ(flown.rig.outcome(request), "1 3");
  const auto other = flown.move_j(start);
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(other), StartsWith("1 4:0108"));
  const auto hold = flown.rig.call("HOLD");
  flown.cycle(3);
  EXPECT_EQ(flown.rig.outcome(hold), "1 3 7");
  EXPECT_EQ(flown.rig.outcome(request), "1 3 8:0204");
  const auto next = move_p(flange_at(beside));
  flown.finish(next);
  EXPECT_EQ(flown.rig.outcome(next), done);
}

}  // namespace
}  // namespace hirosco
