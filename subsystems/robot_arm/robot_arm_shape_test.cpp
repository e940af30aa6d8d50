// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/flown.hpp"

/// What an arm carries is seen: fingers that are somebody else's, a tool and a payload that were declared (docs/adr/0194).
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::descriptor_for;
using robot_arm::testing::file_with;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using robot_arm::testing::model_of;
using robot_arm::testing::replace_all;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double volume_m = 0.03;

struct Carrying {
  Flown flown;
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});

  explicit Carrying(const std::string& descriptor = descriptor_for(6, std::string{folder} + "robot_arm.urdf"))
      : flown{model_of(std::string{folder} + "robot_arm.urdf"), descriptor} {
    flown.plant.place(start);
    flown.operate();
  }
  [[nodiscard]] robotics::Pose tip_at(const JointVector& joints) const {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    robotics::State state;
    state.q = joints;
    state.qd = JointVector::Zero(6);
    dynamics.update(state);
    return dynamics.frame_pose(flown.model.find_frame("tool").value());
  }
  std::string asked(const char* function, const std::vector<double>& numbers) {
    const auto request = flown.ask(function, numbers);
    flown.cycle(3);
    return flown.rig.outcome(request);
  }
  void keep_out(const robotics::Vector3& place) {
    std::vector<double> numbers{place.x(), place.y(), place.z(), place.x(), place.y(), place.z(), volume_m};
    numbers.resize(28, 0.0);
    ASSERT_EQ(asked("KEEP_OUT", numbers), "1 3 7");
  }
  std::string goes() {
    std::vector<double> numbers(goal.begin(), goal.end());
    numbers.push_back(1);
    return asked("MOVE_J", numbers);
  }
};

[[nodiscard]] auto names(std::string_view pair) {
  return ::testing::AllOf(StartsWith("1 4:800a"), HasSubstr(testing::hex(std::as_bytes(std::span{pair}))));
}

/// 0.3 m before the tip there is nothing, unless something is declared.
const robotics::Vector3 before_tip{0, 0.3, 0};

TEST(RobotArmThatCarries, GoesBesideAVolumeThatNothingOfItReaches) {
  Carrying arm;
  arm.keep_out(arm.tip_at(arm.goal) * before_tip);
  EXPECT_EQ(arm.goes(), "1 3");
}

TEST(RobotArmThatCarries, LeadsNoToolIntoAVolume) {
  Carrying arm;
  arm.keep_out(arm.tip_at(arm.goal) * before_tip);
  ASSERT_EQ(arm.asked("SET_TOOL", {0, 0.3, 0, 0, 0, 0, 0}), "1 3 7");
  EXPECT_THAT(arm.goes(), names("the tool and a volume"));
  ASSERT_EQ(arm.asked("SET_TOOL", {0, 0, 0, 0, 0, 0, 0}), "1 3 7");
  EXPECT_EQ(arm.goes(), "1 3");
}

TEST(RobotArmThatCarries, LeadsNoToolIntoAVolumeOnALine) {
  Carrying arm;
  ASSERT_EQ(arm.asked("SET_TOOL", {0, 0.3, 0, 0, 0, 0, 0}), "1 3 7");
  const robotics::Pose tip = arm.tip_at(arm.start);
  const robotics::Vector3 to = tip * before_tip + robotics::Vector3{-0.1, 0.075, 0.05};
  arm.keep_out(to);
  const robotics::Quaternion kept{tip.rotation};
  const auto line =
      arm.flown.ask("MOVE_L", {to.x(), to.y(), to.z(), kept.w(), kept.x(), kept.y(), kept.z(), 0.25, 0.5});
  arm.flown.finish(line);
  EXPECT_THAT(arm.flown.rig.outcome(line), HasSubstr(":800a"));
  EXPECT_LT(arm.flown.off(arm.start), 1e-3) << "it was judged before it went";
}

TEST(RobotArmThatCarries, LeadsNoPayloadIntoAVolumeNorWhatIsNearItsLine) {
  for (const auto& [radius_m, aside_m, refused] : {std::tuple{0.0, 0.0, true}, {0.0, 0.12, false}, {0.1, 0.12, true}}) {
    Carrying arm;
    arm.keep_out(arm.tip_at(arm.goal) * robotics::Vector3{aside_m, 0.25, 0});
    arm.flown.write("TOOL_RADIUS", radius_m);
    ASSERT_EQ(arm.asked("SET_PAYLOAD", {1, 0, 0.3, 0}), "1 3 7");
    const std::string outcome = arm.goes();
    if (refused) {
      EXPECT_THAT(outcome, names("the payload and a volume")) << radius_m;
    } else {
      EXPECT_EQ(outcome, "1 3") << aside_m;
    }
  }
}

/// The tip is built 56 mm before its own wrist where that rolls to 0: a tool that is wider than that is not in it.
TEST(RobotArmThatCarries, RollsItsWristThroughZeroWithAToolAsWideAsTheTipIsFarFromTheWrist) {
  for (const auto& [radius_m, length_m] : {std::pair{0.05, 0.3}, {0.1, 0.3}, {0.05, 0.02}}) {
    const std::string which = std::to_string(radius_m) + " m, " + std::to_string(length_m) + " m";
    Carrying arm;
    arm.flown.write("TOOL_RADIUS", radius_m);
    ASSERT_EQ(arm.asked("SET_TOOL", {0, length_m, 0, 0, 0, 0, 0}), "1 3 7") << which;
    for (const double roll : {-0.7, 0.0}) {
      JointVector goal = arm.start;
      goal[4] = roll;
      const auto request = arm.flown.move_j(goal);
      arm.flown.finish(request);
      EXPECT_EQ(arm.flown.rig.outcome(request), "1 3 5:0001 7") << which << ", to " << roll;
    }
  }
}

/// A finger of the file that slides by 0.3 m and is somebody else's: where it is nobody tells the arm.
TEST(RobotArmThatCarries, LeadsNoFingerOfSomebodyElseIntoAVolumeThatItMayReach) {
  std::string text = descriptor::file_system()(std::string{folder} + "robot_arm.urdf").value();
  text.insert(
      text.rfind("</robot>"),
      "<joint name='slide' type='prismatic'><parent link='tool'/><child link='finger'/><axis xyz='0 1 0'/>"
      "<limit lower='0' upper='0.3' velocity='0.1' effort='10'/></joint>"
      "<link name='finger'><inertial><mass value='0.01'/><inertia ixx='1e-5' ixy='0' ixz='0' iyy='1e-5' iyz='0' "
      "izz='1e-5'/></inertial><collision><geometry><box size='0.02 0.02 0.02'/></geometry></collision></link>");
  std::string descriptor = descriptor_for(6, file_with("fingered.urdf", text));
  replace_all(descriptor, "<Setting name=\"MODEL_FILE\"",
              "<Setting name=\"FIXED\" value=\"slide\"/><Setting name=\"MODEL_FILE\"");
  Carrying arm{descriptor};
  arm.keep_out(arm.tip_at(arm.goal) * before_tip);
  EXPECT_THAT(arm.goes(), names("finger and a volume"));
}

}  // namespace
}  // namespace hirosco
