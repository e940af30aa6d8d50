// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "subsystems/robot_arm/testing/homing.hpp"
#include "subsystems/robot_arm/testing/sensing.hpp"
#include "tools/new_folder/robot.hpp"

/// What `hirosco new robot` writes, beside what the subsystem itself flies (docs/adr/0115).
namespace hirosco::tools {
namespace {

namespace fs = std::filesystem;

[[nodiscard]] std::string text_of(const char* file) {
  return descriptor::file_system()(fs::path{HIROSCO_SOURCE_DIR} / file).value();
}

void replace(std::string& text, std::initializer_list<std::pair<std::string_view, std::string_view>> words) {
  for (const auto& [from, to] : words)
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
}

/// Of the house's arm: what stands for words of its template, and its descriptor, written as the subsystem's.
struct House {
  NewParts parts;
  std::string descriptor;
};
[[nodiscard]] House house_with(const Equipment& equipment) {
  const auto house =
      judge_robot(fs::path{HIROSCO_SOURCE_DIR} / "subsystems/robot_arm/robot_arm.urdf", descriptor::file_system(), "");
  EXPECT_TRUE(house.robot && house.warnings.empty());
  const auto name = new_name("arm").value();
  House made{.parts = parts_of(house.robot.value(), name, equipment), .descriptor = {}};
  made.descriptor = named_text(text_of("templates/robot/newpart.xml"), name, made.parts);
  replace(made.descriptor, {{"page/arm.urdf", "robot_arm.urdf"}, {"address=\"arm", "address=\"robot-arm"}});
  return made;
}

/// Without comments and housekeeping, in which it may be told more than a test needs, and line by line.
[[nodiscard]] std::string without_words(const std::string& text) {
  std::string made;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string line = text.substr(begin, end - begin);
    const std::size_t first = std::min(line.find_first_not_of(" \n"), line.size());
    const std::string_view said = std::string_view{line}.substr(first);
    if (!said.empty() && !said.starts_with("<!--") && !said.starts_with("<HKService id=\"4716\"") &&
        !said.starts_with("<HKService id=\"4717\""))
      made += line;
    begin = end;
  }
  return made;
}

/// The descriptor that the arm of the house flies is the one that would be written for its file: neither goes on without the other.
TEST(NewRobot, ItsDescriptorIsTheOneOfTheSubsystemItself) {
  EXPECT_EQ(house_with({}).descriptor, without_licence(text_of("subsystems/robot_arm/robot_arm.xml")));
}

/// What it has besides is what the tests of the subsystem have besides, but for its numbers.
TEST(NewRobot, ItsWristAndItsHomingAreThoseOfTheSubsystemItself) {
  const House made = house_with({.homing = true, .wrist_sensor = true});
  const auto& words = made.parts.words;
  std::string tried =
      robot_arm::testing::with_force_sensor(without_licence(text_of("subsystems/robot_arm/robot_arm.xml")));
  tried = robot_arm::testing::with_homing(tried, {.order = words.at("@homing_order@"),
                                                  .speed = words.at("@homing_speed@"),
                                                  .torque = words.at("@homing_torque@"),
                                                  .distance = words.at("@homing_distance@")});
  std::string found = made.descriptor;
  // Of the one as large as the strongest drive, of the other as the sensor that was guessed.
  const std::string force = words.at("@wrist_force@"), moment = words.at("@wrist_moment@");
  const auto range = [](const std::string& most) {
    return "init=\"" + most + "\" minimum=\"" + most + "\" maximum=\"" + most + "\"";
  };
  replace(found, {{"minimum=\"0\" maximum=\"150\"/>\n      <ParamRef name=\"DISTANCE\"",
                   "minimum=\"0\" maximum=\"30\"/>\n      <ParamRef name=\"DISTANCE\""},
                  {"unit=\"N\" " + range(force), "unit=\"N\" " + range("100")},
                  {"unit=\"N m\" " + range(moment), "unit=\"N m\" " + range("10")}});
  EXPECT_EQ(without_words(found), without_words(tried));
}

/// The same of the gripper at the end of an arm, but for what nobody knows better of any drive.
TEST(NewRobot, TheDescriptorOfAGripperIsTheOneOfTheSubsystemItself) {
  const auto house = judge_robot(fs::path{HIROSCO_SOURCE_DIR} / "missions/arm_and_fingers/page/arm_and_fingers.urdf",
                                 descriptor::file_system(), "palm", "left_slide");
  ASSERT_TRUE(house.robot);
  const auto name = new_name("arm").value();
  std::string made = named_text(text_of("templates/robot/newpart_gripper.xml"), name, parts_of(*house.robot, name));
  replace(made, {{"page/arm.urdf", "robot_gripper.urdf"},
                 {"      <Setting name=\"FINGERS\" value=\"left_slide\"/>\n", ""},
                 {"ARM_GRIPPER", "GRIPPER"},
                 {"init=\"0.3\" minimum=\"0\" maximum=\"100\"", "init=\"2\" minimum=\"0\" maximum=\"100\""},
                 {"address=\"arm", "address=\"robot"}});
  EXPECT_EQ(made, without_licence(text_of("subsystems/robot_gripper/robot_gripper.xml")));
}

}  // namespace
}  // namespace hirosco::tools
