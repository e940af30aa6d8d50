// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tools/new_folder/robot.hpp"

/// What `hirosco new robot` writes, beside what the subsystem itself flies (docs/adr/0115).
namespace hirosco::tools {
namespace {

namespace fs = std::filesystem;

[[nodiscard]] std::string text_of(const char* file) {
  return descriptor::file_system()(fs::path{HIROSCO_SOURCE_DIR} / file).value();
}

/// The descriptor that the arm of the house flies is the one that would be written for its file: neither goes on without the other.
TEST(NewRobot, ItsDescriptorIsTheOneOfTheSubsystemItself) {
  const auto house =
      judge_robot(fs::path{HIROSCO_SOURCE_DIR} / "subsystems/robot_arm/robot_arm.urdf", descriptor::file_system(), "");
  ASSERT_TRUE(house.robot);
  EXPECT_TRUE(house.warnings.empty());
  const auto name = new_name("arm").value();
  std::string made = named_text(text_of("templates/robot/newpart.xml"), name, parts_of(*house.robot, name));
  for (const auto& [from, to] :
       {std::pair{"page/arm.urdf", "robot_arm.urdf"}, {"address=\"arm", "address=\"robot-arm"}})
    for (std::size_t at = 0; (at = made.find(from, at)) != std::string::npos; at += std::string_view{to}.size())
      made.replace(at, std::string_view{from}.size(), to);
  EXPECT_EQ(made, without_licence(text_of("subsystems/robot_arm/robot_arm.xml")));
}

/// The same of the gripper at the end of an arm, but for what nobody knows better of any drive.
TEST(NewRobot, TheDescriptorOfAGripperIsTheOneOfTheSubsystemItself) {
  const auto house = judge_robot(fs::path{HIROSCO_SOURCE_DIR} / "missions/arm_and_fingers/page/arm_and_fingers.urdf",
                                 descriptor::file_system(), "palm", "left_slide");
  ASSERT_TRUE(house.robot);
  const auto name = new_name("arm").value();
  std::string made = named_text(text_of("templates/robot/newpart_gripper.xml"), name, parts_of(*house.robot, name));
  for (const auto& [from, to] :
       {std::pair{"page/arm.urdf", "robot_gripper.urdf"},
        {"      <Setting name=\"FINGERS\" value=\"left_slide\"/>\n", ""},
        {"ARM_GRIPPER", "GRIPPER"},
        {"init=\"0.3\" minimum=\"0\" maximum=\"100\"", "init=\"2\" minimum=\"0\" maximum=\"100\""},
        {"address=\"arm", "address=\"robot"}})
    for (std::size_t at = 0; (at = made.find(from, at)) != std::string::npos; at += std::string_view{to}.size())
      made.replace(at, std::string_view{from}.size(), to);
  EXPECT_EQ(made, without_licence(text_of("subsystems/robot_gripper/robot_gripper.xml")));
}

}  // namespace
}  // namespace hirosco::tools
