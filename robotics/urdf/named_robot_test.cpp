// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/urdf/named_robot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

namespace hirosco::robotics::urdf {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// An arm of two joints, the second of which is a finger, and a hand with two ends.
[[nodiscard]] std::string forked() {
  std::string text = R"(<robot name="forked"><link name="base"/>)";
  for (const char* link : {"hand", "finger", "thumb"})
    text += std::string{"<link name='"} + link +
            "'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>";
  const std::string ends_at = "<limit lower='0' upper='1' velocity='1' effort='1'/></joint>";
  text += "<joint name='turn' type='revolute'><parent link='base'/><child link='hand'/><axis xyz='0 0 1'/>" + ends_at;
  text +=
      "<joint name='slide' type='prismatic'><parent link='hand'/><child link='finger'/><axis xyz='1 0 0'/>" + ends_at;
  text += "<joint name='still' type='fixed'><parent link='hand'/><child link='thumb'/></joint></robot>";
  return text;
}

/// ARM with these settings.
[[nodiscard]] descriptor::SubsystemDescriptor with_settings(const std::map<std::string, std::string>& settings) {
  descriptor::SubsystemDescriptor subsystem;
  subsystem.devices.resize(1);
  subsystem.devices[0].name = "ARM";
  descriptor::Configuration configuration;
  configuration.devices.resize(1);
  for (const auto& [name, value] : settings)
    configuration.devices[0].settings.push_back({.name = name, .value = value, .at = {}});
  subsystem.configurations.push_back(std::move(configuration));
  return subsystem;
}

struct NamedRobotTest : ::testing::Test {
  std::string file = ::testing::TempDir() + "forked.urdf";
  void SetUp() override { std::ofstream{file} << forked(); }
};

TEST_F(NamedRobotTest, IsTheOneOfTheFileWithoutWhatIsSomebodyElses) {
  const auto settings = with_settings({{"MODEL_FILE", file}, {"FIXED", "slide"}, {"TIP", "thumb"}});
  const auto named = read_named(settings, "ARM");
  ASSERT_TRUE(named) << named.error().text;
  EXPECT_EQ(named->text, forked());
  EXPECT_EQ(named->model.joint_count(), 1);
  EXPECT_THAT(named->standing, ElementsAre("slide"));
  EXPECT_THAT(named->led, ElementsAre(1u)) << "'slide'";
  const auto tip = named_tip(settings, "ARM", *named);
  ASSERT_TRUE(tip);
  EXPECT_EQ(tip->index, named->model.find_frame("thumb")->index);
}

TEST_F(NamedRobotTest, SaysWithTheNamesOfTheSettingAndTheDeviceWhatIsNotThere) {
  const auto why = [](const std::map<std::string, std::string>& settings) -> std::string {
    const auto subsystem = with_settings(settings);
    const auto named = read_named(subsystem, "ARM");
    if (!named) return named.error().text;
    const auto tip = named_tip(subsystem, "ARM", *named);
    return tip ? "" : tip.error().text;
  };
  EXPECT_THAT(why({}), HasSubstr("setting MODEL_FILE of ARM"));
  EXPECT_THAT(why({{"MODEL_FILE", file + "x"}}), HasSubstr("forked.urdfx"));
  EXPECT_THAT(why({{"MODEL_FILE", file}, {"FIXED", "turn,wheel"}}),
              HasSubstr("FIXED of ARM: the robot has no joint 'wheel'"));
  EXPECT_THAT(why({{"MODEL_FILE", file}}), HasSubstr("several ends: setting TIP of ARM"));
  EXPECT_THAT(why({{"MODEL_FILE", file}, {"TIP", "toe"}}), HasSubstr("TIP of ARM: the robot has no link 'toe'"));
  std::ofstream{file} << "<robot>";
  EXPECT_THAT(why({{"MODEL_FILE", file}}), HasSubstr("forked.urdf:1:"));
}

TEST(ListedNames, AreThoseBetweenCommas) {
  EXPECT_THAT(listed_names("a,b_2"), ElementsAre("a", "b_2"));
  EXPECT_THAT(listed_names(""), ElementsAre());
}

}  // namespace
}  // namespace hirosco::robotics::urdf
