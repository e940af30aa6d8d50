// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "hirosco/descriptor/testing.hpp"

/// Which services a mode may permit, of whom.
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

}  // namespace
}  // namespace hirosco::descriptor
