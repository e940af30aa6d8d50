// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/member_reach.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/descriptor/testing.hpp"

/// Nobody's sandbox lets it in where the supervisor's side holds an endnode (docs/adr/0150).
namespace hirosco::descriptor {
namespace {

using namespace testing;

/// The mission of the test data, where the coronagraph's second inhibit and its device, and another's device, are reached so.
Reading<Mission> reached_by(const std::string& enable, const std::string& own = "", const std::string& others = "") {
  std::string robot = file_system()(data / "coronagraph.xml").value();
  std::string wheel = file_system()(data / "flywheel.xml").value();
  robot = changed(R"(transfer="shared_memory" address="orbiter-robot-enable")", enable, robot);
  if (!own.empty()) robot = changed(R"(transfer="udp" address="127.0.0.1:5001")", own, robot);
  if (!others.empty()) wheel = changed(R"(transfer="shared_memory" address="orbiter-stick")", others, wheel);
  return read_mission(data / "mission.xml", overlay({{"coronagraph.xml", robot}, {"flywheel.xml", wheel}}));
}
std::string first_code(const Reading<Mission>& reading) {
  return reading.problems.empty() ? "" : reading.problems[0].code;
}
const std::string in_memory = R"(transfer="shared_memory" address="robot")";

TEST(SecondInhibit, IsReachedByNoSubsystemWhereItIsInSharedMemory) {
  const auto reading = reached_by(R"(transfer="shared_memory" address="robot-enable")", in_memory);
  EXPECT_TRUE(reading.value) << first_code(reading);
}

TEST(SecondInhibit, IsRefusedWhereItsOwnSubsystemsSandboxLetsItIn) {
  const auto reading = reached_by(R"(transfer="unix" address="robot-enable")", R"(transfer="unix" address="robot")");
  ASSERT_EQ(first_code(reading), "E0349");
  EXPECT_EQ(reading.problems[0].file, data / "coronagraph.xml");
  EXPECT_GT(reading.problems[0].at.line, 1);
  EXPECT_EQ(
      first_code(reached_by(R"(transfer="message_queue" address="b")", R"(transfer="message_queue" address="a")")),
      "E0349");
  EXPECT_EQ(
      first_code(reached_by(R"(transfer="serial" address="b@115200")", R"(transfer="serial" address="a@115200")")),
      "E0349")
      << "two pseudo-terminals";
  EXPECT_EQ(first_code(reached_by(R"(transfer="serial" address="/dev/ttyS0@115200")",
                                  R"(transfer="serial" address="/dev/ttyS0@9600")")),
            "E0349")
      << "one line";
  EXPECT_EQ(first_code(reached_by(R"(transfer="udp" address="127.0.0.1:5002")")), "E0349");
}

TEST(SecondInhibit, IsRefusedWhereAnothersSandboxLetsThatOneIn) {
  const std::string local = R"(transfer="unix" address="robot-enable")";
  EXPECT_TRUE(reached_by(local, in_memory).value) << "nobody makes such sockets";
  const auto reading = reached_by(local, in_memory, R"(transfer="unix" address="stick")");
  ASSERT_EQ(first_code(reading), "E0349");
  EXPECT_NE(reading.problems[0].message.find("FLYWHEEL"), std::string::npos) << reading.problems[0].message;
}

TEST(SecondInhibit, IsRefusedWhereASandboxLetsSomebodyInToAFallBackOfIts) {
  const auto with = [&](const std::string& other) {
    return reached_by(R"(transfer="shared_memory" address="robot-enable" silence_ms="30"><FallBack )" + other +
                          R"(/></Enable><Power transfer="shared_memory" address="power")",
                      in_memory, R"(transfer="unix" address="stick")");
  };
  EXPECT_EQ(first_code(with(R"(transfer="unix" address="robot-enable-b")")), "E0349");
  EXPECT_TRUE(with(R"(transfer="shared_memory" address="robot-enable-b")").value);
}

TEST(SecondInhibit, OfTwoLinesIsTheOneThatIsNoSubsystems) {
  EXPECT_TRUE(
      reached_by(R"(transfer="serial" address="/dev/ttyS1@115200")", R"(transfer="serial" address="/dev/ttyS0@115200")")
          .value);
}

TEST(SecondInhibit, IsRefusedAtAPseudoTerminalsOwnNameWhereASubsystemReachesAllOfThem) {
  EXPECT_EQ(
      first_code(reached_by(R"(transfer="serial" address="/dev/pts/3@9600")", R"(transfer="serial" address="a@9600")")),
      "E0349");
}

TEST(MemberReach, IsOfAllEndnodesOfAllConfigurationsAndOfTheGroundLink) {
  MissionSubsystem member;
  member.subsystem.configurations.resize(2);
  DeviceUse use;
  use.endnode.transfer = Transfer::Udp;
  use.endnode.address = "127.0.0.1:5000";
  member.subsystem.configurations[0].devices = {use};
  use.fall_backs = {use.endnode};
  use.fall_backs[0].address = "127.0.0.1:5001";
  member.subsystem.configurations[1].devices = {use};
  std::vector<std::string> addresses;
  for (const FlowAddress& flow : flows_of(member.subsystem)) addresses.push_back(flow.address);
  EXPECT_EQ(addresses, (std::vector<std::string>{"127.0.0.1:5000", "127.0.0.1:5000", "127.0.0.1:5001"}));
  Sandbox sandbox;
  let_in_links(member, sandbox);
  EXPECT_EQ(sandbox.sockets, SandboxSockets{});
  member.carries_ground = true;
  let_in_links(member, sandbox);
  EXPECT_EQ(sandbox.sockets, (SandboxSockets{.datagrams = true, .streams = true}));
}

TEST(MissionSubsystemSockets, AreThoseOfTheGroundLinkAndOfLinksByUdp) {
  const auto reading = read_mission(data / "mission.xml", file_system());
  ASSERT_TRUE(reading.value);
  for (const MissionSubsystem& member : reading.value->subsystems) {
    EXPECT_EQ(member.carries_ground, member.subsystem.name == reading.value->ground.subsystem);
    EXPECT_EQ(std::ranges::count(member.link_methods, LinkMethod::Udp), 0) << member.subsystem.name;
  }
  const std::string both = R"(methods="udp shared_memory")";
  const auto robot = changed(R"(methods="shared_memory")", both, file_system()(data / "coronagraph.xml").value());
  const auto wheel = changed(R"(<Requires name="PLATE_STATE")", R"(<Requires name="PLATE_STATE" )" + both,
                             file_system()(data / "flywheel.xml").value());
  const auto udp = read_mission(data / "mission.xml", overlay({{"coronagraph.xml", robot}, {"flywheel.xml", wheel}}));
  ASSERT_TRUE(udp.value) << first_code(udp);
  for (const MissionSubsystem& member : udp.value->subsystems)
    EXPECT_EQ(std::ranges::count(member.link_methods, LinkMethod::Udp) == 1,
              member.subsystem.name == "FLYWHEEL" || member.subsystem.name == "CORONAGRAPH")
        << member.subsystem.name;
}

}  // namespace
}  // namespace hirosco::descriptor
