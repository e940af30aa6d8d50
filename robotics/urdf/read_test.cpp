// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robotics/urdf/robot.hpp"

namespace hirosco::robotics::urdf {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* gripper = R"(<?xml version="1.0"?>
<robot name="GRIPPER" xmlns:xacro="http://wiki.ros.org/xacro">
  <material name="grey"><color rgba="1 1 1 1"/></material>
  <link name="palm"><inertial><origin xyz="0 0 0.1" rpy="0 0 1.5707963267948966"/><mass value=" 2.5 "/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="2" iyz="0" izz="2.5"/></inertial><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="left_joint" type="prismatic">
    <origin xyz="0.1 0 0"/><parent link="palm"/><child link="left"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.04" velocity="0.2" effort="20"/><dynamics damping="10" friction="0.5"/>
  </joint>
  <joint name="flange" type="fixed"><parent link="palm"/><child link="tip"/><origin xyz="0 0 1"/></joint>
  <joint name="right_joint" type="prismatic">
    <parent link="palm"/><child link="right"/><axis xyz="0 -1 0"/>
    <limit lower="0" upper="0.04" velocity="0.2" effort="20"/><mimic joint="left_joint"/>
  </joint>
  <link name="left"><inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1E-4"/></inertial></link>
  <link name="right"><inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="+1e-4"/></inertial></link>
  <link name="tip"/>
</robot>)";

TEST(UrdfReader, TakesLinksAndJointsAsTheyStand) {
  const auto reading = read("gripper.urdf", gripper);
  ASSERT_THAT(reading.problems, IsEmpty()) << reading.problems.front().message;
  EXPECT_THAT(reading.warnings, IsEmpty()) << reading.warnings.front().message;
  const Robot& robot = *reading.value;
  EXPECT_EQ(robot.name, "GRIPPER");
  EXPECT_EQ(robot.links[robot.root].name, "palm");
  const Inertia& palm = robot.links[0].inertia.value();
  EXPECT_EQ(palm.mass, 2.5);
  EXPECT_EQ(palm.centre, Vector3(0, 0, 0.1));
  EXPECT_NEAR(palm.about_centre(0, 0), 2, 1e-15);  // turned by a quarter
  EXPECT_NEAR(palm.about_centre(1, 1), 1, 1e-15);
  EXPECT_FALSE(robot.links[3].inertia);
  const Joint& left = robot.joints[0];
  EXPECT_EQ(left.type, JointType::Prismatic);
  EXPECT_EQ(left.axis, Vector3::UnitY());
  EXPECT_EQ(left.origin.position, Vector3(0.1, 0, 0));
  EXPECT_EQ(left.damping, 10);
  EXPECT_EQ(left.friction, 0.5);
  EXPECT_EQ(left.limits.upper, 0.04);
  EXPECT_EQ(left.limits.velocity, 0.2);
  EXPECT_EQ(left.limits.effort, 20);
  EXPECT_FALSE(left.mimic);
  ASSERT_TRUE(robot.joints[2].mimic);
  EXPECT_EQ(robot.joints[2].mimic->joint, 0U);
  EXPECT_EQ(robot.joints[2].mimic->multiplier, 1);
  EXPECT_THAT(tips(robot), ElementsAre("left", "right", "tip"));
}

TEST(UrdfReader, TurnsByRollThenPitchThenYawAboutFixedAxes) {
  const auto reading = read("a.urdf", R"(<robot name="A"><link name="a"/><link name="b"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
    <joint name="j" type="continuous"><parent link="a"/><child link="b"/><origin rpy="1.5707963267948966 0 1.5707963267948966"/></joint></robot>)");
  ASSERT_TRUE(reading.value);
  // z goes to -y by the roll, and that to x by the yaw.
  EXPECT_LT((reading.value->joints[0].origin.rotation * Vector3::UnitZ() - Vector3::UnitX()).norm(), 1e-15);
  EXPECT_EQ(reading.value->joints[0].axis, Vector3::UnitX());
  EXPECT_FALSE(reading.value->joints[0].limits.lower);
}

TEST(UrdfReader, FollowsChainsOfMimicJointsToTheOneThatMovesByItself) {
  std::string text = R"(<robot name="A"><link name="l0"/>)";
  const auto joint = [&](int i, const char* mimic) {
    const std::string n = std::to_string(i);
    text +=
        "<link name=\"l" + n +
        R"("><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>)" +
        "<joint name=\"j" + n + "\" type=\"continuous\"><parent link=\"l0\"/><child link=\"l" + n + "\"/>" + mimic +
        "</joint>";
  };
  joint(1, R"(<mimic joint="j2" multiplier="2" offset="0.5"/>)");
  joint(2, R"(<mimic joint="j3" multiplier="-3" offset="0.25"/>)");
  joint(3, "");
  joint(4, R"(<mimic joint="j1" multiplier="0.5"/>)");
  const auto reading = read("a.urdf", text + "</robot>");
  ASSERT_TRUE(reading.value);
  const auto& joints = reading.value->joints;
  EXPECT_EQ(joints[0].mimic->joint, 2U);
  EXPECT_EQ(joints[0].mimic->multiplier, -6);
  EXPECT_EQ(joints[0].mimic->offset, 1);
  EXPECT_EQ(joints[3].mimic->joint, 2U);
  EXPECT_EQ(joints[3].mimic->multiplier, -3);
  EXPECT_EQ(joints[3].mimic->offset, 0.5);
}

TEST(UrdfReader, TakesHowFastAJointMaySpeedUpWhereTheFileSaysIt) {
  std::string text{gripper};
  const std::string velocity = "velocity=\"0.2\"";
  text.insert(text.find(velocity), R"(acceleration="3" deceleration="2" jerk="4" )");
  const auto reading = read("gripper.urdf", text);
  ASSERT_TRUE(reading.value) << reading.problems.front().message;
  EXPECT_TRUE(reading.warnings.empty());
  const auto& limits = reading.value->joints[0].limits;
  EXPECT_EQ(limits.acceleration, 2) << "holds both ways";
  EXPECT_EQ(limits.jerk, 4);
  EXPECT_FALSE(reading.value->joints[2].limits.acceleration);
}

TEST(UrdfReader, TakesAsciiWhateverEncodingIsDeclaredAndSaysWhatToDoWithOthers) {
  const auto declared = [](const std::string& text) {
    return read("a.urdf", "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n" + text);
  };
  const std::string text = std::string{gripper}.substr(std::string_view{gripper}.find("<robot"));
  EXPECT_TRUE(declared(text).value);
  const std::string palm = "\"palm\"";
  const auto replaced = [&](const std::string& name) {
    std::string other = text;
    for (auto at = other.find(palm); at != std::string::npos; at = other.find(palm))
      other.replace(at, palm.size(), name);
    return declared(other);
  };
  const auto latin = replaced("\"pa\xEC\"");
  ASSERT_EQ(latin.problems.size(), 1U);
  EXPECT_EQ(latin.problems[0].code, "U0002") << "an octet that is no UTF-8";
  EXPECT_THAT(latin.problems[0].hint, HasSubstr("iconv -f ISO-8859-1 -t UTF-8"));
  const auto both = replaced("\"pa\xC3\xAC\"");
  ASSERT_EQ(both.problems.size(), 1U);
  EXPECT_EQ(both.problems[0].code, "U0003") << "octets that mean one thing by the declaration, and another as UTF-8";
  EXPECT_EQ(both.problems[0].at.line, 1);
  EXPECT_THAT(both.problems[0].hint, HasSubstr("iconv"));
}

TEST(UrdfReader, OfATagThatIsNotClosedItSaysNothingOfEncodings) {
  std::string text{gripper};
  const auto end = text.find("</link>");
  text.erase(end, std::string_view{"</link>"}.size());
  const auto reading = read("a.urdf", text);
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_EQ(reading.problems[0].code, "U0002");
  EXPECT_THAT(reading.problems[0].hint, HasSubstr("close each tag"));
  EXPECT_THAT(reading.problems[0].hint, ::testing::Not(HasSubstr("UTF-8")));
}

TEST(UrdfReader, NamesWhatItPassesOverOnceForEachKindAndHowOften) {
  std::string text{gripper};
  text.insert(text.find("  <link name=\"palm\""), R"(<gazebo reference="palm"/><gazebo/>
<transmission name="t"/><drake:declare_convex/>)");
  text.replace(text.find("<robot "), 7, "<robot xmlns:drake=\"d\" ");
  const auto reading = read("gripper.urdf", text);
  ASSERT_TRUE(reading.value);
  ASSERT_EQ(reading.warnings.size(), 3U);
  EXPECT_EQ(reading.warnings[0].code, "U0501");
  EXPECT_THAT(reading.warnings[0].message, HasSubstr("<gazebo> in <robot> is passed over, 2 times"));
  EXPECT_EQ(reading.warnings[0].at.line, 4);
}

TEST(UrdfReader, SaysWhyAFileCannotBeRead) {
  const auto reading = read("nowhere.urdf", [](const std::filesystem::path&) -> Result<std::string> {
    return fail(ErrorCode::NotFound, "is a folder");
  });
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_EQ(reading.problems[0].code, "U0001");
  EXPECT_THAT(reading.problems[0].message, HasSubstr("is a folder"));
}

}  // namespace
}  // namespace hirosco::robotics::urdf
