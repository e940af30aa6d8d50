// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/flown.hpp"

/// The posture that an arm prefers, of which a descriptor, a configuration or a telecommand speaks (docs/adr/0219).
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::descriptor_for;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using robot_arm::testing::model_of;
using robot_arm::testing::replace_all;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string six_axes_file = std::string{folder} + "robot_arm.urdf",
                  seven_axes_file = std::string{folder} + "floating/floating_arm.urdf";
const std::string posture_begins = R"(<ParamRef name="POSTURE" id="47" type="DOUBLE" )",
                  gain_begins = R"(<ParamRef name="POSTURE_GAIN" id="48" type="DOUBLE" unit="1/s" init=)";

/// An arm of seven joints that weighs nothing, slow enough for its drives.
std::string weightless(const std::string& preferred) {
  std::string text = descriptor_for(7, seven_axes_file);
  replace_all(text, R"(init="0 0 -9.81")", R"(init="0 0 0")");
  replace_all(text, R"(unit="rad/s2" init="4")", R"(unit="rad/s2" init="0.3")");
  replace_all(text, R"(unit="rad/s3" init="40")", R"(unit="rad/s3" init="3")");
  replace_all(text, R"(unit="m" minimum="-2" maximum="2")", R"(unit="m" minimum="-4" maximum="4")");
  if (preferred.empty()) return text;
  replace_all(text, posture_begins, posture_begins + "init=\"" + preferred + "\" ");
  replace_all(text, gain_begins + "\"0\"", gain_begins + "\"1\"");
  return text;
}

struct SevenJoints {
  const std::string done = "1 3 5:0001 7";
  Flown flown;
  JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});
  /// With the tool nearly in the same pose, and the elbow swung.
  JointVector swung = vector_of(std::array{0.424, 0.806, -0.18, -1.25, -0.448, 1.786, -0.257});

  explicit SevenJoints(const std::string& preferred) : flown{model_of(seven_axes_file), weightless(preferred)} {
    flown.plant.set_gravity(robotics::Vector3::Zero());
    flown.plant.step_s = 250e-6;
    flown.plant.place(swung);
    flown.operate();
  }
  /// The pose of the tool with the joints there.
  std::string move_p_to(const JointVector& there) {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    dynamics.update({.q = there, .qd = JointVector::Zero(7)});
    const robotics::Pose pose = dynamics.frame_pose(flown.model.find_frame("tool").value());
    const robotics::Quaternion wxyz{pose.rotation};
    const auto request = flown.ask(
        "MOVE_P", {pose.position.x(), pose.position.y(), pose.position.z(), wxyz.w(), wxyz.x(), wxyz.y(), wxyz.z(), 1});
    flown.finish(request);
    return flown.rig.outcome(request);
  }
};

TEST(RobotArmPosture, IsTheOneToWhichAPoseLeadsFromWhereverTheArmStands) {
  SevenJoints arm{"0.10 0.75 -0.30 -1.25 -0.05 1.85 0.0"};
  EXPECT_EQ(arm.move_p_to(arm.ready), arm.done);
  EXPECT_LT(arm.flown.off(arm.ready), 2e-3);
  const auto away = arm.flown.move_j(arm.swung);
  arm.flown.finish(away);
  ASSERT_EQ(arm.flown.rig.outcome(away), arm.done);
  EXPECT_EQ(arm.move_p_to(arm.ready), arm.done);
  EXPECT_LT(arm.flown.off(arm.ready), 2e-3) << "the same branch twice";
  EXPECT_EQ(arm.flown.rig.inhibited(), 0u);
}

TEST(RobotArmPosture, IsWhereItStandsUnlessSomebodySaysAnother) {
  SevenJoints arm{""};
  EXPECT_EQ(arm.move_p_to(arm.ready), arm.done);
  EXPECT_LT(arm.flown.off(arm.swung), 0.1);
}

/// The second joint ends at 2.2.
TEST(RobotArmPosture, ThatItCannotTakeIsRefusedWithTheJointThatCannot) {
  Flown flown{6, six_axes_file};
  const JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  flown.plant.place(start);
  flown.rig.bring_to(State::PreOperational, 1);
  flown.cycle(5);
  flown.command(State::SafeOperational);
  flown.write("POSTURE", 2.5);
  flown.command(State::Operational);
  const std::string words = "POSTURE is out of the range of joint";
  const auto asked = [&](const char* function, const std::vector<double>& numbers) {
    const auto request = flown.ask(function, numbers);
    flown.cycle(3);
    return flown.rig.outcome(request);
  };
  const std::vector<double> pose{0.4, 0.1, 0.6, 1, 0, 0, 0, 0.5}, line{0.4, 0.1, 0.6, 1, 0, 0, 0, 0.1, 0.5};
  EXPECT_THAT(asked("MOVE_P", pose), StartsWith("1 3")) << "nobody goes by it yet";
  flown.cycle(200);
  static_cast<void>(asked("HOLD", {}));
  flown.cycle(500);
  flown.command(State::SafeOperational);
  flown.write("POSTURE_GAIN", 1);
  flown.command(State::Operational);
  for (const auto& [function, numbers] : {std::pair{"MOVE_P", pose}, {"MOVE_L", line}}) {
    const std::string outcome = asked(function, numbers);
    EXPECT_THAT(outcome, StartsWith("1 4:8002")) << function;
    EXPECT_THAT(outcome, HasSubstr("0000000000000002" + testing::hex(std::as_bytes(std::span{words})))) << function;
  }
}

/// Of a configuration that is to be in force.
TEST(RobotArmPosture, ThatItCannotTakeIsNotConfigured) {
  for (const auto& [its, count, told] :
       {std::tuple{"0 2.5 0 0 0 0", "6", "POSTURE is out of the range of joint"},
        std::tuple{"0 0 0 0 0", "5", "POSTURE has another length than the robot has joints"}}) {
    std::string text = descriptor_for(6, six_axes_file);
    replace_all(text, posture_begins + "count=\"6\"", posture_begins + "count=\"" + count + "\" init=\"" + its + "\"");
    replace_all(text, gain_begins + "\"0\"", gain_begins + "\"1\"");
    const auto arm = make_robot_arm();
    testing::Rig rig{*arm, text};
    ASSERT_EQ(rig.set_state_now(State::PreOperational), "1 3 7") << ::testing::PrintToString(rig.explanations);
    EXPECT_THAT(rig.configure_now(1), StartsWith("1 3 8:")) << told;
    EXPECT_THAT(rig.explanations, Contains(HasSubstr(told)));
  }
}

TEST(RobotArmPosture, IsSomethingThatADescriptorMayLeaveOut) {
  std::string text = descriptor_for(6, six_axes_file);
  for (const std::string& its : {posture_begins, gain_begins}) {
    const auto from = text.find(its);
    ASSERT_NE(from, std::string::npos) << its;
    text.erase(from, text.find("/>", from) + 2 - from);
  }
  Flown flown{model_of(six_axes_file), text};
  flown.plant.place(vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1}));
  flown.operate();
  const auto motion = flown.move_j(vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0}));
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 5:0001 7");
}

}  // namespace
}  // namespace hirosco
