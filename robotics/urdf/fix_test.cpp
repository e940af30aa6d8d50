// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "robotics/urdf/robot.hpp"

namespace hirosco::robotics::urdf {
namespace {

const std::string mass =
    R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>)";
const std::string limit = R"(<limit lower="0" upper="1" velocity="1" effort="1"/>)";
/// An arm of one joint with a pair of fingers, the second of which follows the first and is 0.2 m ahead.
const std::string fingers =
    R"(<robot name="f"><link name="base"/><link name="arm">)" + mass + R"(<link name="left">)" + mass +
    R"(<link name="right">)" + mass + R"(<joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>)" +
    limit +
    R"(</joint><joint name="one" type="prismatic"><origin xyz="0 0 1"/><parent link="arm"/><child link="left"/>
  <axis xyz="1 0 0"/>)" +
    limit + R"(</joint><joint name="two" type="prismatic"><origin xyz="0 0 1"/><parent link="arm"/>
  <child link="right"/><axis xyz="-1 0 0"/>)" +
    limit + R"(<mimic joint="one" offset="0.2"/></joint></robot>)";

TEST(Fix, MakesAJointAndWhatFollowsItPartOfWhatCarriesThem) {
  auto reading = read("f.urdf", fingers);
  ASSERT_TRUE(reading.value);
  ASSERT_EQ(fix(*reading.value, std::array<std::string, 1>{"one"}), std::nullopt);
  const auto description = describe(*reading.value);
  ASSERT_EQ(description.joints.size(), 1u);
  EXPECT_EQ(description.joints[0].name, "turn");
  EXPECT_EQ(description.joints[0].moved.mass, 3);
  const auto right = std::ranges::find(description.frames, "right", &FrameDescription::name);
  ASSERT_NE(right, description.frames.end());
  EXPECT_EQ(right->placement.position, Vector3(-0.2, 0, 1)) << "where it would follow to";
  EXPECT_TRUE(Model::make(description));
}

TEST(Fix, NamesWhatIsNoJointThatMovesByItselfAndChangesNothing) {
  auto reading = read("f.urdf", fingers);
  ASSERT_TRUE(reading.value);
  EXPECT_EQ(fix(*reading.value, std::array<std::string, 2>{"one", "thumb"}), "thumb");
  EXPECT_EQ(fix(*reading.value, std::array<std::string, 1>{"two"}), "two");
  EXPECT_EQ(describe(*reading.value).joints.size(), 3u);
}

TEST(Fix, IsAskedBeforeAndAfterWhatHangsOnWhatStands) {
  auto reading = read("f.urdf", fingers);
  ASSERT_TRUE(reading.value);
  const auto led = [&](const char* name) { return led_by(*reading.value, std::array<std::string, 1>{name}); };
  EXPECT_EQ(led("one"), (std::vector<std::size_t>{1, 2})) << "with what follows it";
  EXPECT_EQ(led("two"), std::vector<std::size_t>{}) << "it does not move by itself";
  const auto turn = led("turn"), one = led("one");
  for (int times = 0; times < 2; ++times) {
    EXPECT_EQ(carried_by(*reading.value, one, "arm"), std::nullopt) << "fingers hang on it";
    EXPECT_EQ(carried_by(*reading.value, {}, "right"), std::nullopt);
    const auto right = carried_by(*reading.value, one, "right");
    ASSERT_TRUE(right) << "it slides with a finger";
    EXPECT_EQ(right->by, 2u);
    EXPECT_EQ(right->what, "link 'right'");
    if (times == 0) {
      const auto finger = carried_by(*reading.value, turn, "base");
      ASSERT_TRUE(finger);
      EXPECT_EQ(finger->by, 0u);
      EXPECT_EQ(finger->what, "joint 'one'");
      ASSERT_EQ(fix(*reading.value, std::array<std::string, 1>{"one"}), std::nullopt);
    }
  }
}

}  // namespace
}  // namespace hirosco::robotics::urdf
