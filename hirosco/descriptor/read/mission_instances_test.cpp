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

/// The flywheel with a switch of its power and two fall-backs, and a second one with what stands inside.
Reading<Mission> two_switched(const std::string& inside) {
  const std::string end = R"(<Endnode transfer="shared_memory" address="orbiter-stick")",
                    stick = R"(<Device name="STICK">)";
  std::string wheel = changed(end + "/>",
                              end + R"(><FallBack transfer="unix" address="orbiter-stick-2"/>)"
                                    R"(<FallBack transfer="shared_memory" address="orbiter-stick-3"/></Endnode>)",
                              file_system()(data / "flywheel.xml").value());
  wheel = changed(stick, stick + R"(<Power transfer="shared_memory" address="orbiter-power"/>)", wheel);
  return read_mission(data / "mission.xml",
                      overlay({{"mission.xml", with_second_flywheel(inside)}, {"flywheel.xml", wheel}}));
}
const std::string moved_ends =
    R"(<FallBack address="orbiter-stick-2" to="left-2"/><FallBack address="orbiter-stick-3" to="left-3"/>)";

TEST(MissionInstances, HaveFallBacksAndASwitchOfTheirOwn) {
  const auto reading =
      two_switched(R"(<Device name="STICK" address="left" power="left-power">)" + moved_ends + "</Device>");
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const MissionSubsystem& left = reading.value->subsystems.at(3);
  const auto ends_of = [](const SubsystemDescriptor& subsystem) {
    const DeviceUse& use = subsystem.configurations.front().devices.front();
    std::string ends = subsystem.power_switches.front().endnode.address + " " + use.endnode.address;
    for (const Endnode& other : use.fall_backs)
      ends += " " + std::string{to_text(other.transfer)} + ":" + other.address;
    return ends;
  };
  EXPECT_EQ(ends_of(left.subsystem), "left-power left unix:left-2 shared_memory:left-3");
  EXPECT_EQ(ends_of(reading.value->subsystems.at(2).subsystem),
            "orbiter-power orbiter-stick unix:orbiter-stick-2 shared_memory:orbiter-stick-3");
  SubsystemDescriptor launched = reading.value->subsystems.at(2).subsystem;
  for (const auto& [word, text] : changes_of(left)) ASSERT_TRUE(apply_change(launched, word, text)) << word << text;
  EXPECT_EQ(ends_of(launched), ends_of(left.subsystem)) << "its process makes the same of the same file";
}

TEST(MissionInstances, MeetByAFallBackOrASwitchThatTheMissionLeaves) {
  const auto told = [](const std::string& inside) {
    const auto reading = two_switched(inside);
    return reading.problems.empty() ? std::string{} : reading.problems[0].code + " " + reading.problems[0].message;
  };
  const std::string of_stick = R"(<Device name="STICK" address="left" )", end = "</Device>";
  EXPECT_EQ(told(of_stick + R"(power="left-power"/>)"), "E0313 'orbiter-stick-2' is a device's of 'FLYWHEEL'");
  EXPECT_EQ(told(of_stick + ">" + moved_ends + end), "E0313 'orbiter-power' is a device's of 'FLYWHEEL'");
  const std::string owned = of_stick + R"(power="left-power">)";
  EXPECT_EQ(told(owned + moved_ends + R"(<FallBack address="none" to="left-4"/></Device>)"),
            "E0217 'none': nothing of it falls back to this address");
  EXPECT_EQ(told(owned + R"(<FallBack address="orbiter-stick-3" to="left"/></Device>)"),
            "E0217 'orbiter-stick-3': the device has that address already");
  EXPECT_EQ(told(owned + moved_ends + moved_ends + end).substr(0, 5), "E0201");
  EXPECT_EQ(told(owned + R"(<FallBack address="orbiter-stick-3" to=""/></Device>)"), "E0217 '' is no address");
  EXPECT_EQ(told(owned + R"(<FallBack address="orbiter-stick-3"/></Device>)").substr(0, 5), "E0105");
  EXPECT_EQ(told(of_stick + R"(power="left">)" + moved_ends + end),
            "E0222 address 'left' of device 'STICK' belongs to the power switch of device 'STICK'");
  EXPECT_EQ(told(R"(<Device name="STICK" address="orbiter-stick-3" power="left-power">)"
                 R"(<FallBack address="orbiter-stick-2" to="left-2"/></Device>)"),
            "E0222 'orbiter-stick-3' is tried already");
  const std::string plain = with_second_flywheel(of_stick + R"(power="left-power"/>)");
  const auto unswitched = read_mission(data / "mission.xml", overlay({{"mission.xml", plain}}));
  ASSERT_FALSE(unswitched.problems.empty());
  EXPECT_EQ(unswitched.problems[0].message, "'left-power': nothing switches its power");
}

TEST(MissionInstances, NameOneOfSeveralEndnodesByItsDeviceAndThePowerByTheDevice) {
  const std::string input = R"(<Input><Field name="ANGLE" type="DOUBLE" count="2" unit="rad"/></Input>)";
  const std::string wheel =
      changed("<Endnode transfer", R"(<Endnode name="HEAD" transfer)",
              changed(input,
                      R"(<Power transfer="shared_memory" address="orbiter-power"/><Endnode name="HEAD">)" + input +
                          "</Endnode>",
                      file_system()(data / "flywheel.xml").value()));
  const auto read = [&](const std::string& inside) {
    return read_mission(data / "mission.xml",
                        overlay({{"mission.xml", with_second_flywheel(inside)}, {"flywheel.xml", wheel}}));
  };
  const auto reading = read(R"(<Device name="STICK.HEAD" address="left"/><Device name="STICK" power="left-power"/>)");
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  EXPECT_EQ(reading.value->subsystems.at(3).subsystem.power_switches.front().endnode.address, "left-power");
  const auto whole = read(R"(<Device name="STICK" address="left" power="left-power"/>)");
  ASSERT_FALSE(whole.problems.empty());
  EXPECT_EQ(whole.problems[0].message, "'left': no such device; one of several endnodes is DEVICE.ENDNODE");
}

TEST(MissionInstances, ChangesOfAnotherFormAreRefused) {
  SubsystemDescriptor robot = read_subsystem(data / "coronagraph.xml", file_system()).value.value();
  for (const auto& [word, text] :
       {std::pair{"--as", "ARM"}, std::pair{"--as", ":12"}, std::pair{"--as", "ARM:x"}, std::pair{"--as", "ARM:70000"},
        std::pair{"--address", "PLATE"}, std::pair{"--address", "PLATE="}, std::pair{"--other", "PLATE=x"},
        std::pair{"--power", "PLATE="}, std::pair{"--fall-back", "PLATE=x"}, std::pair{"--fall-back", "PLATE==x"},
        std::pair{"--fall-back", "PLATE=x="}})
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
