// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "hirosco/descriptor/model/setting_files.hpp"
#include "hirosco/descriptor/testing.hpp"

/// What a mission changes in the descriptors of its subsystems.
namespace hirosco::descriptor {
namespace {

using testing::changed;
using testing::data;
using testing::overlay;
using testing::rendered;

/// A second flywheel of the same descriptor, as the mission names it.
std::string with_second_flywheel(const std::string& inside, const std::string& identity = R"(name="LEFT" id="30")") {
  const std::string first = R"(<Subsystem executable="hirosco-flywheel" descriptor="flywheel.xml"/>)";
  return changed(first, first + R"(<Subsystem executable="hirosco-flywheel" descriptor="flywheel.xml" )" + identity +
                            ">" + inside + "</Subsystem>");
}

TEST(MissionInstances, OfOneDescriptorHaveNameIdParametersAndAddressesOfTheirOwn) {
  const auto source = overlay({{"mission.xml", with_second_flywheel(R"(<Device name="STICK" address="left"/>)")}});
  const auto reading = read_mission(data / "mission.xml", source);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, source);
  const MissionSubsystem& left = reading.value->subsystems.at(3);
  EXPECT_EQ(left.subsystem.name, "LEFT");
  EXPECT_EQ(left.subsystem.id, 30);
  EXPECT_EQ(left.subsystem.file, reading.value->subsystems.at(2).subsystem.file);
  EXPECT_EQ(reading.value->find_subsystem(30), &left);
  for (const auto& configuration : left.subsystem.configurations)
    for (const auto& use : configuration.devices) EXPECT_EQ(use.endnode.address, "left");
  // Its process makes the same of the same file.
  SubsystemDescriptor launched = read_subsystem(data / "flywheel.xml", file_system()).value.value();
  for (const auto& [word, text] : changes_of(left)) ASSERT_TRUE(apply_change(launched, word, text)) << word << text;
  EXPECT_EQ(launched.name, "LEFT");
  EXPECT_EQ(launched.id, 30);
  EXPECT_EQ(launched.configurations.front().devices.front().endnode.address, "left");
}

TEST(MissionInstances, HaveSettingsOfTheirDevicesOfTheirOwnWhichTheirProcessesMakeOfTheSameFile) {
  const Mission mission = read_mission(data / "mission.xml", file_system()).value.value();
  const auto stiffness = [](const SubsystemDescriptor& robot) {
    const auto said = setting_of_all(robot, "PLATE", "STIFFNESS");
    return said ? *said : "different ones";
  };
  const MissionSubsystem& robot = mission.subsystems.at(1);
  SubsystemDescriptor launched = read_subsystem(data / "coronagraph.xml", file_system()).value.value();
  EXPECT_EQ(stiffness(launched), "4000");
  EXPECT_EQ(stiffness(robot.subsystem), "4500");
  for (const auto& [word, text] : changes_of(robot)) ASSERT_TRUE(apply_change(launched, word, text)) << word << text;
  EXPECT_EQ(stiffness(launched), "4500");
  ASSERT_TRUE(apply_change(launched, "--setting", "PLATE:STIFFNESS=a=b:c"));
  EXPECT_EQ(stiffness(launched), "a=b:c") << "a value is what is behind the first equals sign";
  for (const char* unknown : {"PLATE:STIFNESS=1", "PLATES:STIFFNESS=1"})
    EXPECT_EQ(apply_change(launched, "--setting", unknown).error().code, ErrorCode::NotFound) << unknown;
  for (const char* wrong : {"PLATE", "PLATE:STIFFNESS", "STIFFNESS=1:2"})
    EXPECT_EQ(apply_change(launched, "--setting", wrong).error().code, ErrorCode::InvalidArgument) << wrong;
}

TEST(MissionInstances, ThatMeetAreRefused) {
  const auto problem_of = [](const std::string& mission) {
    const auto source = overlay({{"mission.xml", mission}});
    const auto reading = read_mission(data / "mission.xml", source);
    return reading.problems.empty() ? std::string{} : reading.problems.front().code;
  };
  const std::string own = R"(<Device name="STICK" address="left"/>)";
  EXPECT_EQ(problem_of(with_second_flywheel("")), "E0313") << "two devices with one address";
  EXPECT_EQ(problem_of(with_second_flywheel(own, R"(name="LEFT")")), "E0302");
  EXPECT_EQ(problem_of(with_second_flywheel(own, R"(id="30")")), "E0301");
  EXPECT_EQ(problem_of(with_second_flywheel(own, R"(name="LEFT" id="1")")), "E0303");
  EXPECT_EQ(problem_of(with_second_flywheel(own, R"(name="LEFT" id="2040")")), "E0112");
  EXPECT_EQ(problem_of(with_second_flywheel(R"(<Device name="STIKC" address="left"/>)")), "E0312");
  EXPECT_EQ(problem_of(with_second_flywheel(R"(<Device name="STICK"/>)")), "E0105");
  EXPECT_EQ(problem_of(with_second_flywheel(own + own)), "E0201");
  EXPECT_EQ(problem_of(with_second_flywheel(R"(<Device name="STICK" address="left" enable="x"/>)")), "E0217")
      << "it has no second inhibit";
}

TEST(MissionInstances, ChangesOfAnotherFormAreRefused) {
  SubsystemDescriptor robot = read_subsystem(data / "coronagraph.xml", file_system()).value.value();
  for (const auto& [word, text] :
       {std::pair{"--as", "ARM"}, std::pair{"--as", ":12"}, std::pair{"--as", "ARM:x"}, std::pair{"--as", "ARM:70000"},
        std::pair{"--address", "PLATE"}, std::pair{"--address", "PLATE="}, std::pair{"--other", "PLATE=x"}})
    EXPECT_EQ(apply_change(robot, word, text).error().code, ErrorCode::InvalidArgument) << word << " " << text;
  EXPECT_EQ(apply_change(robot, "--address", "NONE=x").error().code, ErrorCode::NotFound);
}

TEST(MissionOverrides, ReachALaunchedSubsystemAsTheyWereRead) {
  const Mission mission = read_mission(data / "mission.xml", file_system()).value.value();
  SubsystemDescriptor robot = read_subsystem(data / "coronagraph.xml", file_system()).value.value();
  ASSERT_EQ(mission.subsystems.at(1).overrides.size(), 1U);
  EXPECT_EQ(to_string(mission.subsystems.at(1).overrides.at(0)), "DES_POSITION=-0.7 1.5");
  for (const Override& changed : {Override{"TORQUE_LIMIT", {0.1}}, Override{"DES_POSITION", {-1.0 / 3, 1e-300}}}) {
    ASSERT_TRUE(apply_override(robot, to_string(changed)));
    EXPECT_EQ(robot.find_parameter(changed.parameter)->init, changed.values);
  }
  EXPECT_EQ(apply_override(robot, "NONE=1").error().code, ErrorCode::NotFound);
  for (const auto& [name, type] : {std::pair{"TITLE", Type::Text}, std::pair{"ON", Type::Bool}}) {
    Field& field = robot.parameters.emplace_back().field;
    field.name = name;
    field.type = type;
    field.text_octets = 8;
  }
  for (const Override& changed : {Override{"TITLE", {"a b = c"}}, Override{"TITLE", {""}}, Override{"ON", {1}}}) {
    ASSERT_TRUE(apply_override(robot, to_string(changed))) << to_string(changed);
    EXPECT_EQ(robot.find_parameter(changed.parameter)->init, changed.values);
  }
  EXPECT_EQ(apply_override(robot, "TITLE=123456789").error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(apply_override(robot, "ON=2").error().code, ErrorCode::OutOfRange);
  for (const char* wrong : {"DES_POSITION", "DES_POSITION=", "DES_POSITION=1", "DES_POSITION=1 2 3", "DES_POSITION=1 x",
                            "DES_POSITION=1  2", "DES_POSITION=1 2 "})
    EXPECT_EQ(apply_override(robot, wrong).error().code, ErrorCode::OutOfRange) << wrong;
}

}  // namespace
}  // namespace hirosco::descriptor
