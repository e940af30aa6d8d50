// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/st08_function/function_service.hpp"
#include "supervisor/supervision/telecommand/called_function.hpp"
#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using supervisor::LogKind;
using supervisor::LogRecord;

constexpr std::array rokviss{"COMMUNICATION", "MANIPULATOR", "JOYSTICK"};

TEST(Commissioning, RokvissReachesTelepresenceWithAllOperationalAndBothLinksUp) {
  Flight flight{{}};
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  for (const char* name : rokviss) EXPECT_EQ(flight.state(name), State::Operational) << name;
  EXPECT_EQ(flight.craft().supervisor().own_state(), State::Operational);
  EXPECT_EQ(flight.craft().supervisor().mode().name, "telepresence");
  EXPECT_EQ(flight.craft().supervisor().links().up_count(), 2u);
  EXPECT_TRUE(flight.story().has("commissioned: mode telepresence"));
}

TEST(Commissioning, EverySubsystemPassesItsStatesInOrder) {
  Flight flight{{}};
  ASSERT_TRUE(flight.commission());
  for (const std::string name : rokviss) {
    std::vector<std::string> wanted;
    for (const char* state : {"SoftwareInit", "HardwareInit", "PreOperational", "SafeOperational", "Operational"})
      wanted.push_back(name + " info STATE_CHANGED STATE=" + state);
    EXPECT_EQ(flight.story().missing_in_order(wanted), "") << flight.story().text();
    EXPECT_EQ(flight.story().count(name + " info STATE_CHANGED"), wanted.size());
  }
}

TEST(Commissioning, AStartListThatThePowerDoesNotSufficeForStopsAtTheStepThatIsRefused) {
  Flight flight{{.edit = [](descriptor::Mission& mission) { mission.power_budget_w = 100; }}};
  EXPECT_FALSE(flight.commission());
  EXPECT_EQ(flight.story().missing_in_order({"power short: JOYSTICK asks for 25 W, 80 W of 100 W are reserved",
                                             "commissioning stopped: JOYSTICK SafeOperational: power budget exceeded"}),
            "")
      << flight.story().text();
  EXPECT_EQ(flight.state("JOYSTICK"), State::PreOperational);
}

/// Subtypes of ST[01] reports on a request, in order of the log.
std::vector<int> verification_of(const std::vector<LogRecord>& records, std::uint32_t request_id) {
  std::vector<int> subtypes;
  for (const LogRecord& record : records) {
    const auto report = pus::TelemetryView::parse(record.packet);
    if (!report || report->service() != 1) continue;
    OctetReader reader{report->source_data()};
    if (reader.get<std::uint32_t>() == request_id) subtypes.push_back(report->subtype());
  }
  return subtypes;
}

TEST(Commissioning, EachStepIsALoggedTelecommandWithItsVerification) {
  Flight flight{{}};
  ASSERT_TRUE(flight.commission());
  flight.craft().run(50ms);
  const auto records = flight.records();
  std::vector<std::string> steps;
  for (const LogRecord& record : records) {
    if (record.kind != LogKind::TelecommandForwarded) continue;
    const auto telecommand = pus::TelecommandView::parse(record.packet);
    ASSERT_TRUE(telecommand);
    const auto call = supervisor::called_function(*telecommand);
    if (!call) continue;  // the handshake of service 128
    steps.push_back(std::to_string(record.peer) + " " + std::string{call->name});
    EXPECT_EQ(verification_of(records, telecommand->request_id()), (std::vector{1, 7})) << steps.back();
    EXPECT_TRUE(std::ranges::any_of(records,
                                    [&](const LogRecord& other) {
                                      return other.kind == LogKind::TelecommandReceived &&
                                             other.packet == record.packet;
                                    }))
        << steps.back() << " is not logged as received";
  }
  const std::vector<std::string> expected{"1 SET_STATE", "1 CONFIGURE",  "1 SET_STATE",
                                          "1 SET_STATE",               // the supervisor itself
                                          "2 SET_STATE", "10 SET_STATE", "11 SET_STATE",  // Pre-Operational
                                          "2 CONFIGURE", "10 CONFIGURE", "11 CONFIGURE",  //
                                          "1 LINK",      "1 LINK",  //
                                          "2 SET_STATE", "10 SET_STATE", "11 SET_STATE",  // Safe-Operational
                                          "2 SET_STATE", "10 SET_STATE", "11 SET_STATE",  // Operational
                                          "1 ENTER_MODE"};
  EXPECT_EQ(steps, expected);
}

TEST(Commissioning, StopsWithALineWhenASubsystemNeverAnswers) {
  Flight flight{{}};
  flight.craft().stop("JOYSTICK", true);
  EXPECT_FALSE(flight.commission());
  EXPECT_EQ(flight.story().missing_in_order(
                {"JOYSTICK SET_STATE 3: no answer", "commissioning stopped: JOYSTICK PreOperational: no answer"}),
            "")
      << flight.story().text();
  EXPECT_FALSE(flight.craft().supervisor().succeeded());
  EXPECT_EQ(flight.craft().supervisor().mode().name, "commissioning");
  EXPECT_EQ(flight.state("MANIPULATOR"), State::PreOperational);
}

descriptor::Configuration& coupled(descriptor::MissionSubsystem& member) {
  return *std::ranges::find(member.subsystem.configurations, "COUPLED", &descriptor::Configuration::name);
}

TEST(Commissioning, StopsWithALineWhenAConfigurationFails) {
  Plan plan;
  plan.edit = [](descriptor::Mission& mission) {
    for (auto& member : mission.subsystems)
      if (member.subsystem.name == "JOYSTICK") coupled(member).devices.front().endnode.address = "manipulator-robot";
  };
  Flight flight{plan};
  EXPECT_FALSE(flight.commission());
  EXPECT_EQ(flight.story().missing_in_order(
                {"JOYSTICK: CONFIGURE COUPLED failed: device JOYSTICK: this side of the flow is open",
                 "commissioning stopped: JOYSTICK configuration COUPLED: execution error"}),
            "")
      << flight.story().text();
  EXPECT_FALSE(flight.craft().supervisor().succeeded());
}

TEST(Commissioning, StopsWithALineWhenALinkIsRefused) {
  Plan plan;
  plan.edit = [](descriptor::Mission& mission) {
    for (auto& member : mission.subsystems)
      if (member.subsystem.name == "JOYSTICK") coupled(member).requires_.front().fields[1].name = "FORCE";
  };
  Flight flight{plan};
  EXPECT_FALSE(flight.commission());
  EXPECT_EQ(flight.story().missing_in_order(
                {"link 1 MANIPULATOR.ROBOT_STATE -> JOYSTICK down: ", "commissioning stopped: SUPERVISOR link 1"}),
            "")
      << flight.story().text();
  EXPECT_TRUE(flight.story().has("FORCE")) << "the refusal names the field: " << flight.story().text();
  EXPECT_NE(flight.state("JOYSTICK"), State::SafeOperational);
}

}  // namespace
}  // namespace hirosco::testing
