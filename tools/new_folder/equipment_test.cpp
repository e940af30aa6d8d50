// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/equipment.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/new_folder/robot.hpp"

/// What an arm has besides what its file tells: the numbers that are guessed, and the lines that are written.
namespace hirosco::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

/// Two rods of 1 m and 0.5 kg, one at the end of the other, which turn about y and z.
constexpr const char* two_rods = R"(<robot name="rods">
<link name="base"/>
<joint name="lift" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/><limit lower="-1" upper="3" velocity="3" effort="72"/>
<dynamics damping="2" friction="4"/></joint>
<link name="upper"><inertial><origin xyz="0.5 0 0"/><mass value="0.5"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.0417" iyz="0" izz="0.0417"/></inertial></link>
<joint name="swing" type="revolute"><origin xyz="1 0 0"/><parent link="upper"/><child link="lower"/><axis xyz="0 0 1"/><limit lower="-2" upper="1" velocity="0.25" effort="36"/></joint>
<link name="lower"><inertial><origin xyz="0.5 0 0"/><mass value="0.5"/><inertia ixx="0.001" ixy="0" ixz="0" iyy="0.0417" iyz="0" izz="0.0417"/></inertial></link>
<joint name="end" type="fixed"><origin xyz="1 0 0"/><parent link="lower"/><child link="tool"/></joint><link name="tool"/>
</robot>)";

[[nodiscard]] NewRobot rods() {
  return judge_robot(
             "rods.urdf", [](const fs::path&) -> Result<std::string> { return std::string{two_rods}; }, "")
      .robot.value();
}
[[nodiscard]] std::string template_text(const char* file) {
  return descriptor::file_system()(fs::path{HIROSCO_SOURCE_DIR} / "templates/robot" / file).value();
}
/// A file of the template as it is written for the two rods.
[[nodiscard]] std::string written(const char* file, const Equipment& equipment) {
  const auto name = new_name("rods").value();
  return named_text(template_text(file), name, parts_of(rods(), name, equipment));
}

TEST(Equipment, HasAMarkASecondsWayOffWithinTheRangeOfEachJoint) {
  const NewRobot robot = rods();
  ASSERT_EQ(robot.marks.size(), 2U);
  EXPECT_NEAR(robot.marks[0].speed, 0.1, 1e-12) << "to the middle of its range";
  EXPECT_NEAR(robot.marks[1].speed, -0.05, 1e-12) << "a fifth of its velocity, to the other side";
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(robot.marks[i].mark, robot.posture[i] + robot.marks[i].speed, 1e-12);
    EXPECT_NEAR(robot.marks[i].distance, 4 * std::abs(robot.marks[i].speed), 1e-12);
  }
}

TEST(Equipment, LooksForMarksWithWhatFrictionAndWhatItMovesNeedAndNotMuchMore) {
  const NewRobot robot = rods();
  // 0.4 rad/s2: 0.1 rad/s in 0.25 s. About the base a rod of its own, and one whose middle is 1.5 m off; the rotor; friction and damping.
  const double lift = 0.4 * (0.0417 + 0.5 * 0.25 + 0.0417 + 0.5 * 2.25 + 72.0 / 300) + 4 + 2 * 0.1;
  EXPECT_NEAR(robot.marks[0].torque, 3 * lift, 1e-3);
  EXPECT_NEAR(robot.marks[1].torque, 3.6, 1e-9) << "a tenth of its effort at least";
}

TEST(Equipment, HasASensorThatFeelsAThirdOfWhatJointsDo) {
  // 0.3 of 72 N m at 2 m, or of 36 N m at 1 m: joints feel 10.8 N, and a third of that is 0.3 of 12 N, which is no round number.
  EXPECT_EQ(rods().wrist_range_n, 10);
}

TEST(Equipment, AnArmWithoutItHasNothingOfIt) {
  for (const char* file : {"newpart.xml", "mission.xml", "README.md", "CMakeLists.txt"})
    for (const char* word : {"@homing", "@wrist", "HOM", "WRIST", "FORCE_AGE", "REFERENCE", "encoders", "force_sensor"})
      EXPECT_THAT(written(file, {}), Not(HasSubstr(word))) << file;
  EXPECT_THAT(written("newpart.xml", {}), HasSubstr(R"(init="0 0 -9.81")"));
  EXPECT_THAT(written("mission.xml", {}), HasSubstr(R"(start="operation")"));
  EXPECT_THAT(written("CMakeLists.txt", {}), HasSubstr("--for 4s --at \"2 rods unplug\""));
  EXPECT_THAT(written("CMakeLists.txt", {}), HasSubstr("\"commissioned: mode operation.*ARM_LOST\""));
}

TEST(Equipment, AnArmThatHomesWeighsNothingAndBeginsInAModeOfItsOwn) {
  const Equipment homing{.homing = true};
  const std::string descriptor = written("newpart.xml", homing), mission = written("mission.xml", homing);
  EXPECT_THAT(descriptor, HasSubstr(R"(<ParamRef name="ORDER" id="220" type="UINT8" count="2" init="2 1" )"));
  EXPECT_THAT(descriptor, HasSubstr(R"(unit="rad/s" init="0.1 -0.05")"));
  EXPECT_THAT(descriptor, HasSubstr(R"(<Configuration name="HOMING" id="3")"));
  EXPECT_THAT(descriptor, HasSubstr(R"(name="GRAVITY" id="9" type="DOUBLE" count="3" unit="m/s2" init="0 0 0")"));
  EXPECT_THAT(descriptor, Not(HasSubstr("WRIST")));
  EXPECT_THAT(mission, HasSubstr(R"(<Setting name="gravity" value="0 0 0"/>)"));
  EXPECT_THAT(mission, HasSubstr(R"(<Setting name="encoders" value="0.1,-0.05"/>)"));
  EXPECT_THAT(mission, HasSubstr(R"(start="homing")"));
  EXPECT_THAT(written("README.md", homing), HasSubstr("hirosco tc rods HOME --limit 15s"));
  const std::string test = written("CMakeLists.txt", homing);
  EXPECT_THAT(test,
              HasSubstr(R"(--at "2 tc RODS HOME" --at "6 tc SUPERVISOR SET_MODE operation" --at "9 tc RODS MOVE_J )"));
}

TEST(Equipment, AnArmWithASensorShowsItAndTriesIt) {
  const Equipment wrist{.wrist_sensor = true};
  const std::string descriptor = written("newpart.xml", wrist);
  EXPECT_THAT(descriptor, HasSubstr(R"(unit="N" init="10" minimum="10" maximum="10")"));
  EXPECT_THAT(descriptor, HasSubstr(R"(unit="N m" init="1" minimum="1" maximum="1")"));
  EXPECT_THAT(descriptor, Not(HasSubstr("HOMING")));
  EXPECT_THAT(written("mission.xml", wrist), HasSubstr(R"(<Setting name="force_sensor" value="on"/>)"));
  EXPECT_THAT(written("CMakeLists.txt", wrist),
              HasSubstr(R"(--at "2 rods push 0 0 -5" --at "2.5 rods push 0 0 0" --at "3 rods unplug")"));
  const auto name = new_name("rods").value();
  const auto scene = nlohmann::json::parse(parts_of(rods(), name, wrist).files.at(1).second);
  EXPECT_EQ(scene.at("plots").back().at("curves").at(2).at("name"), "RODS.WRIST.FORCE[2]");
}

TEST(Equipment, ALineOfTwoThingsIsThereWhereBothAre) {
  const auto name = new_name("rods").value();
  const auto text = [&](const Equipment& equipment) {
    return named_text("a\n@homing@@wrist@b\n@wrist@c\n", name, parts_of(rods(), name, equipment));
  };
  EXPECT_EQ(text({}), "a\n");
  EXPECT_EQ(text({.homing = true}), "a\n");
  EXPECT_EQ(text({.wrist_sensor = true}), "a\nc\n");
  EXPECT_EQ(text({.homing = true, .wrist_sensor = true}), "a\nb\nc\n");
}

}  // namespace
}  // namespace hirosco::tools
