// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/yamcs/yamcs_project.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ground/clients/xtce/testing.hpp"

// That Yamcs starts with it, and what it then sees and commands, is shown in tests/export.
namespace hirosco::ground {
namespace {

using ::testing::HasSubstr;
using testing::mission_with;
using Json = nlohmann::ordered_json;

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
  EXPECT_EQ(Json::parse(project_of(mission_with("ARM")).files.at("etc/events.json")),
            Json::parse(R"([{"eventId": "ARM-10", "template": "ARM ARM ARM={/ARM/ARM/ARM_2/ARM} ARM"}])"));
}

TEST(YamcsProject, AStackBringsTheCraftIntoAModeAndAsksWhoIsAlive) {
  const auto files = project_of(mission_with("ARM")).files;
  EXPECT_EQ(Json::parse(files.at("stacks/commission_ARM.ycs")), Json::parse(R"({
    "$schema": "https://yamcs.org/schema/stack.schema.json",
    "advancement": {"acknowledgment": "Verifier_Complete", "wait": 0},
    "steps": [
      {"type": "command", "name": "/ARM/SUPERVISOR/SET_MODE", "arguments": [{"name": "MODE", "value": "ARM"}]},
      {"type": "verify", "timeout": 80000,
       "condition": [{"parameter": "/ARM/SUPERVISOR/MODE", "operator": "eq", "value": 3}]},
      {"type": "command", "name": "/ARM/SUPERVISOR/PING", "arguments": []},
      {"type": "command", "name": "/ARM/ARM/PING", "arguments": []}]})"));
}

TEST(YamcsProject, NoNameLeavesItsFolderItsStringOrItsTemplate) {
  for (const std::string& name : testing::hostile_names()) {
    const auto project = project_of(mission_with(name));
    EXPECT_EQ(project.name.find_first_of("/. "), std::string::npos) << name;
    EXPECT_EQ(project.files.size(), 8U) << name;
    for (const auto& [path, text] : project.files) {
      EXPECT_EQ(path.find(".."), std::string::npos) << path;
      EXPECT_TRUE(!path.ends_with(".ycs") || Json::accept(text)) << text;
    }
    const Json events = Json::parse(project.files.at("etc/events.json"));
    ASSERT_EQ(events.size(), 1U) << name;
    const std::string words = events[0]["template"];
    // One parameter each, and nothing of the name in its braces.
    EXPECT_EQ(std::ranges::count(words, '{'), 1) << words;
    EXPECT_EQ(words.find("{evil}"), std::string::npos);
  }
}

}  // namespace
}  // namespace hirosco::ground
