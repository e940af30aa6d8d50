// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/yamcs/yamcs_project.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ground/clients/xtce/testing.hpp"

// That Yamcs starts with it, and what it then sees and commands, is shown in tests/export.
namespace hirosco::ground {
namespace {

using ::testing::HasSubstr;
using testing::mission_with;

YamcsProject project_of(descriptor::Mission mission) { return yamcs_project(Catalogue{std::move(mission)}); }

TEST(YamcsProject, LinksGoToTheTwoPortsOfTheMission) {
  auto mission = mission_with("ARM");
  mission.ground.telemetry = "127.0.0.1:20015";
  mission.ground.telecommand = "127.0.0.1:20025";
  const auto project = project_of(std::move(mission));
  EXPECT_EQ(project.name, "arm-yamcs");
  EXPECT_THAT(project.files.at("etc/yamcs.arm.yaml"), HasSubstr("port: 20015\n"));
  EXPECT_THAT(project.files.at("etc/yamcs.arm.yaml"), HasSubstr("port: 20025\n"));
  EXPECT_THAT(project.files.at("etc/yamcs.yaml"), HasSubstr("address: 127.0.0.1"));
}

TEST(YamcsProject, AnEventSaysWhoWhatAndItsArguments) {
  EXPECT_THAT(project_of(mission_with("ARM")).files.at("etc/events.json"),
              HasSubstr(R"({"eventId": "ARM-10", "template": "ARM ARM ARM={/ARM/ARM/ARM_2/ARM} ARM"})"));
}

TEST(YamcsProject, AStackBringsTheCraftIntoAModeAndAsksWhoIsAlive) {
  const auto files = project_of(mission_with("ARM")).files;
  const std::string& stack = files.at("stacks/commission_ARM.ycs");
  EXPECT_THAT(stack,
              HasSubstr(R"("name": "/ARM/SUPERVISOR/SET_MODE", "arguments": [{"name": "MODE", "value": "ARM"}])"));
  EXPECT_THAT(stack, HasSubstr(R"({"parameter": "/ARM/SUPERVISOR/MODE", "operator": "eq", "value": 3})"));
  EXPECT_THAT(stack, HasSubstr(R"("name": "/ARM/ARM/PING")"));
}

TEST(YamcsProject, NoNameLeavesItsFolderItsStringOrItsTemplate) {
  for (const std::string& name : testing::hostile_names()) {
    const auto project = project_of(mission_with(name));
    EXPECT_EQ(project.name.find_first_of("/. "), std::string::npos) << name;
    EXPECT_EQ(project.files.size(), 8U) << name;
    for (const auto& [path, text] : project.files) EXPECT_EQ(path.find(".."), std::string::npos) << path;
    const std::string& events = project.files.at("etc/events.json");
    // One parameter each, and nothing of the name in its braces.
    EXPECT_EQ(std::ranges::count(events, '\n'), 3) << events;
    EXPECT_EQ(events.find("{evil}", events.find("template")), std::string::npos);
  }
}

}  // namespace
}  // namespace hirosco::ground
