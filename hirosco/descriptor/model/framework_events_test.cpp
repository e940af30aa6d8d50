// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/framework_events.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "hirosco/descriptor/testing.hpp"

namespace hirosco::descriptor {
namespace {
using namespace testing;

std::string arm(const std::string& events, const std::string& device = "arm") {
  return R"(<Subsystem name="ARM" id="10">
  <EventService>)" +
         events + R"(</EventService>
  <Device name=")" +
         device + R"("><Input><Field name="X" type="DOUBLE"/></Input></Device>
  <Configuration name="ONE" id="1" sampling_us="1000"><RealTimeLinkService>
    <Requires name="HAND"><Field name="X" type="DOUBLE"/></Requires>
  </RealTimeLinkService></Configuration>
  <Configuration name="TWO" id="2" sampling_us="1000"><RealTimeLinkService>
    <Requires name="FOOT"><Field name="X" type="DOUBLE"/></Requires>
    <Requires name="HAND"><Field name="X" type="DOUBLE"/></Requires>
  </RealTimeLinkService></Configuration>
</Subsystem>)";
}

std::string codes(const std::string& text) {
  std::string all;
  for (const auto& problem : read_text(text).problems) all += problem.code + " ";
  return all;
}

TEST(FrameworkEvents, AreThereInADescriptorThatDeclaresNone) {
  const auto subsystem = read_text(R"(<Subsystem name="BARE" id="10"/>)").value.value();
  const std::pair<const char*, std::uint16_t> wanted[]{{"STATE_CHANGED", 0xF000},        {"STATE_FAILED", 0xF001},
                                                       {"CONFIGURATION_FAILED", 0xF002}, {"CYCLE_OVERRUNS", 0xF003},
                                                       {"REPORTS_LOST", 0xF004},         {"SUPERVISOR_SILENT", 0xF005},
                                                       {"CYCLE_OVER_BUDGET", 0xF006},    {"RESOURCE_WARNING", 0xF007},
                                                       {"CYCLE_NOT_REALTIME", 0xF008},   {"SERVICE_USES_HEAP", 0xF00B}};
  EXPECT_EQ(subsystem.events.size(), std::size(wanted));
  for (const auto& [name, id] : wanted) {
    const Event* event = subsystem.find_event(name);
    ASSERT_NE(event, nullptr) << name;
    EXPECT_EQ(event->id, id) << name;
  }
  EXPECT_EQ(subsystem.find_event("STATE_FAILED")->severity, Severity::High);
}

TEST(FrameworkEvents, TellOfEachDeviceAndOfEachRequiredSetOnce) {
  const auto subsystem = read_text(arm("", "left-arm.1")).value.value();
  EXPECT_EQ(subsystem.find_event("left_arm_1_LOST")->id, 0xF100);
  EXPECT_EQ(subsystem.find_event("left_arm_1_LOST")->severity, Severity::High);
  EXPECT_EQ(subsystem.find_event("HAND_STALE")->id, 0xF200);
  EXPECT_EQ(subsystem.find_event("FOOT_STALE")->id, 0xF201);
  EXPECT_EQ(std::ranges::count(subsystem.events, "HAND_STALE", &Event::name), 1);
}

TEST(FrameworkEvents, TakeAnotherSeverityFromTheDescriptorAndNothingElse) {
  const auto subsystem = read_text(arm(R"(<Event name="HAND_STALE" severity="low"/>)")).value.value();
  EXPECT_EQ(subsystem.find_event("HAND_STALE")->severity, Severity::Low);
  EXPECT_EQ(subsystem.find_event("HAND_STALE")->id, 0xF200);
  EXPECT_EQ(subsystem.find_event("HAND_STALE")->arguments.size(), 1U);
  EXPECT_EQ(codes(arm(R"(<Event name="HAND_STALE" severity="low"><Argument name="A" type="UINT8"/></Event>)")),
            "E0213 ");
}

TEST(FrameworkEvents, DeclaredByHandAreRefused) {
  EXPECT_EQ(codes(arm(R"(<Event name="STATE_CHANGED" id="1" severity="info"/>)")), "E0213 ");
  EXPECT_EQ(codes(arm(R"(<Event name="arm_LOST" id="1" severity="info"/>)")), "E0213 ");
}

TEST(FrameworkEvents, AreTheOnlyOnesWithoutAnIdAndWithIdsFromF000) {
  EXPECT_EQ(codes(arm(R"(<Event name="OWN" severity="info"/>)")), "E0105 ");
  EXPECT_EQ(codes(arm(R"(<Event name="OWN" id="61440" severity="info"/>)")), "E0112 ");
  EXPECT_EQ(codes(arm(R"(<Event name="OWN" id="61439" severity="info"/>)")), "");
}

TEST(FrameworkEvents, AddedTwiceAreThereOnce) {
  auto subsystem = read_text(arm("")).value.value();
  const std::size_t events = subsystem.events.size(), enumerations = subsystem.enumerations.size();
  add_framework_events(subsystem);
  EXPECT_EQ(subsystem.events.size(), events);
  EXPECT_EQ(subsystem.enumerations.size(), enumerations);
}

TEST(FrameworkEvents, AnEventThatNoReportCanCarryIsRefused) {
  const auto event = [](int octets) {
    return arm(R"(<Event name="OWN" id="1" severity="info"><Argument name="A" type="UINT8" count=")" +
               std::to_string(octets) + R"("/></Event>)");
  };
  EXPECT_EQ(codes(event(4072)), "");
  EXPECT_EQ(codes(event(4073)), "E0215 ");
}

}  // namespace
}  // namespace hirosco::descriptor
