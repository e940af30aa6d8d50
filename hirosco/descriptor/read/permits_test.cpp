// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hirosco/descriptor/testing.hpp"

/// Which services a mode may permit, of whom, and for whom.
namespace hirosco::descriptor {
namespace {

const std::string open_to_all = R"(<Permit subsystem="*" services="3 17 20"/>)";

/// The good mission with this in the place of a permit, and what the flywheel has besides.
Reading<Mission> with_permit(const std::string& permit, const std::string& of_flywheel = "") {
  const std::string flywheel = file_system()(testing::data / "flywheel.xml").value();
  const std::string events = "  <EventService>";
  return read_mission(testing::data / "mission.xml",
                      testing::overlay({{"mission.xml", testing::changed(open_to_all, permit)},
                                        {"flywheel.xml", testing::changed(events, of_flywheel + events, flywheel)}}));
}

const std::string spin_up =
    R"(<CustomService name="SPIN" type="230"><Request name="SPIN_UP" subtype="1"/></CustomService>)";

std::string permit_problem(const Reading<Mission>& reading) {
  return reading.problems.size() == 1
             ? reading.problems.front().code + " " + reading.problems.front().message
             : testing::rendered(reading.problems, file_system()) + std::to_string(reading.problems.size());
}

TEST(PermittedServices, AreThoseOfSomebodyWhomThePermitMeans) {
  EXPECT_TRUE(with_permit(R"(<Permit subsystem="FLYWHEEL" services="230"/>)", spin_up).value);
  EXPECT_TRUE(with_permit(R"(<Permit subsystem="*" services="3 230"/>)", spin_up).value);
  EXPECT_TRUE(with_permit(R"(<Permit subsystem="SUPERVISOR" services="3 5 20"/>)").value);
}

TEST(PermittedServices, ThatNobodyOfTheseHasAreRefusedWithThoseThatThereAre) {
  EXPECT_EQ(permit_problem(with_permit(R"(<Permit subsystem="*" services="3 231"/>)", spin_up)),
            "E0352 no subsystem has a service 231");
  const auto of_another = with_permit(R"(<Permit subsystem="CORONAGRAPH" services="230"/>)", spin_up);
  EXPECT_EQ(permit_problem(of_another), "E0352 'CORONAGRAPH' has no service 230");
  const auto near = with_permit(R"(<Permit subsystem="FLYWHEEL" services="23 229"/>)", spin_up);
  EXPECT_EQ(permit_problem(near), "E0352 'FLYWHEEL' has no service 229");
  EXPECT_NE(near.problems.at(0).hint.find("230 (SPIN)"), std::string::npos) << near.problems.at(0).hint;
}

TEST(PermittedServices, ThatOneLeavesOutInEveryConfigurationAreNotItsOwnEither) {
  const auto permitted = [](const std::string& of_flywheel) {
    return permit_problem(with_permit(R"(<Permit subsystem="FLYWHEEL" services="5"/>)", of_flywheel));
  };
  EXPECT_EQ(permitted(R"(<Service name="ST05" offered="no"/>)"), "E0352 'FLYWHEEL' has no service 5");
  EXPECT_EQ(permitted(""), "0");
}

const std::string asks_coronagraph = R"(<Commands subsystem="CORONAGRAPH" functions="MOVE_TO"/>)";

TEST(PermittedOrigins, AreTheGroundAndWhoAsksForSomethingOfWhomThePermitMeans) {
  using Names = std::vector<std::string>;
  const auto from = [](const std::string& permit) {
    const auto reading = with_permit(permit, asks_coronagraph);
    return reading.value ? reading.value->modes.at(0).permits.back().from : Names{permit_problem(reading)};
  };
  EXPECT_EQ(from(R"(<Permit subsystem="CORONAGRAPH" functions="MOVE_TO" from="ground FLYWHEEL"/>)"),
            (Names{"ground", "FLYWHEEL"}));
  EXPECT_EQ(from(R"(<Permit subsystem="*" services="3" from="FLYWHEEL"/>)"), Names{"FLYWHEEL"});
  EXPECT_EQ(from(R"(<Permit subsystem="SUPERVISOR" functions="SET_MODE" from="ground"/>)"), Names{"ground"});
  EXPECT_EQ(from(R"(<Permit subsystem="CORONAGRAPH" functions="MOVE_TO"/>)"), Names{});
}

TEST(PermittedOrigins, ThatAreNotThereOrAskForNothingAreRefused) {
  const auto problem = [](const std::string& from, const std::string& whom = "CORONAGRAPH") {
    return permit_problem(
        with_permit(R"(<Permit subsystem=")" + whom + R"(" services="3" from=")" + from + R"("/>)", asks_coronagraph));
  };
  EXPECT_EQ(problem("ground FLYWEEL"), "E0304 subsystem 'FLYWEEL' is not in the mission");
  EXPECT_EQ(problem("Ground"), "E0304 subsystem 'Ground' is not in the mission");
  EXPECT_EQ(problem("SUPERVISOR"), "E0357 'SUPERVISOR' is bound to no mode");
  EXPECT_EQ(problem("FLYWHEEL", "GROUNDSTATION"), "E0357 'FLYWHEEL' asks 'GROUNDSTATION' for nothing");
  EXPECT_EQ(problem("CORONAGRAPH", "*"), "E0357 'CORONAGRAPH' asks nobody for anything");
  EXPECT_EQ(problem("ground ground").substr(0, 5), "E0201");
  EXPECT_EQ(problem(" "), "E0109 attribute 'from' is empty");
}

TEST(PermittedOrigins, OpenNothingOfTheSupervisorThatIsTheGroundsAlone) {
  const auto problem = [](const std::string& from) {
    return permit_problem(
        with_permit(R"(<Permit subsystem="SUPERVISOR" functions="SET_MODE SHUTDOWN" from=")" + from + R"("/>)",
                    R"(<Commands subsystem="SUPERVISOR" reads="MODE"/>)"));
  };
  EXPECT_EQ(problem("FLYWHEEL"), "E0357 'SHUTDOWN' of the supervisor is the ground's alone to ask for");
  EXPECT_EQ(problem("ground FLYWHEEL"), "0");
  EXPECT_EQ(problem("ground"), "0");
}

/// Else it could bring the craft where nobody on ground may ask for anything but a stop and the end of the flight.
TEST(PermittedOrigins, WhoMayAskForModesLeavesTheGroundAWayOutOfEach) {
  const std::string configuration = R"(  <Configuration name="NORMAL")", events = "  <EventService>";
  const std::string in_telepresence = R"(<Permit subsystem="FLYWHEEL" functions="SET_FORCE_SCALE"/>)";
  const auto problem = [&](const std::string& in_commissioning, const std::string& besides,
                           const std::string& declares = "SET_MODE") {
    const std::string mission = testing::changed(open_to_all, open_to_all + in_commissioning);
    const std::string functions =
        R"(<FunctionService><Function name="SET_MODE"/><Function name="SAFE_ALL"/></FunctionService>)";
    const std::string commands = R"(<Commands subsystem="SUPERVISOR" functions=")" + declares + R"("/>)";
    const auto file = [](const char* name) { return file_system()(testing::data / name).value(); };
    return permit_problem(read_mission(
        testing::data / "mission.xml",
        testing::overlay(
            {{"mission.xml", testing::changed(in_telepresence, in_telepresence + besides, mission)},
             {"supervisor.xml", testing::changed(configuration, functions + configuration, file("supervisor.xml"))},
             {"flywheel.xml", testing::changed(events, commands + events, file("flywheel.xml"))}})));
  };
  const std::string of_flywheel = R"(<Permit subsystem="SUPERVISOR" functions="SET_MODE" from="FLYWHEEL"/>)";
  const std::string refused = "E0357 the ground may not leave mode 'telepresence', and 'FLYWHEEL' may ask for modes";
  EXPECT_EQ(problem("", ""), "0") << "nobody on board may";
  EXPECT_EQ(problem(of_flywheel, ""), refused);
  EXPECT_EQ(problem(of_flywheel, of_flywheel), refused);
  EXPECT_EQ(problem("", of_flywheel), refused) << "whichever mode permits it";
  EXPECT_EQ(problem(of_flywheel, R"(<Permit subsystem="SUPERVISOR" functions="SET_MODE"/>)"), "0");
  EXPECT_EQ(problem(of_flywheel, R"(<Permit subsystem="*" functions="*" from="ground FLYWHEEL"/>)"), "0");
  EXPECT_EQ(problem(R"(<Permit subsystem="*" functions="*" from="FLYWHEEL"/>)", "", "SAFE_ALL"), "0")
      << "it declares to ask for no mode";
}

}  // namespace
}  // namespace hirosco::descriptor
