// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "simulation/devices/robot/robot_device.hpp"
#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using pus::FailureCode;

constexpr std::uint16_t supervisor_apid = 1;
constexpr std::uint16_t manipulator_apid = 10;
constexpr std::uint16_t joystick_apid = 11;
constexpr std::uint16_t first_count = 9000;  // far from those of Spacecraft::command

class Telecommands : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(flight.commission()) << flight.story().text(); }

  void expect_done(const simulation::CommandOutcome& outcome) {
    EXPECT_TRUE(outcome.accepted && outcome.started && outcome.completed)
        << "failed with " << (outcome.failure ? std::string{to_text(*outcome.failure)} : "no answer");
  }
  void expect_refused(const simulation::CommandOutcome& outcome, FailureCode code, int subtype) {
    ASSERT_TRUE(outcome.failure);
    EXPECT_EQ(*outcome.failure, code) << to_text(*outcome.failure);
    EXPECT_EQ(outcome.failure_subtype, subtype);
    EXPECT_FALSE(outcome.completed);
  }
  void expect_verdict(const Flight::Verdict& verdict, int subtype, int code, int apid) {
    EXPECT_EQ(verdict.subtype, subtype);
    EXPECT_EQ(verdict.code, code);
    EXPECT_EQ(verdict.apid, apid);
  }
  /// The manipulator on its own: out of the network by way of Post-Operational.
  void go_standalone(State manipulator) {
    expect_done(flight.set_mode("commissioning"));
    for (const State state : {State::SafeOperational, State::PostOperational, State::PreOperational})
      expect_done(flight.set_state("MANIPULATOR", state));
    expect_done(flight.configure("MANIPULATOR", "STANDALONE"));
    expect_done(flight.set_state("MANIPULATOR", State::SafeOperational));
    if (manipulator == State::Operational) expect_done(flight.set_state("MANIPULATOR", State::Operational));
    expect_done(flight.enter_mode("standalone"));
  }

  /// Out of the network into Pre-Operational, to be commissioned alone.
  void take_out(const char* name) {
    expect_done(flight.set_mode("commissioning"));
    if (flight.state(name) == State::Operational) expect_done(flight.set_state(name, State::SafeOperational));
    for (const State state : {State::PostOperational, State::PreOperational})
      expect_done(flight.set_state(name, state));
    expect_done(flight.configure(name, "STANDALONE"));
  }

  Flight flight{{.edit = hand_rests}};
};

TEST_F(Telecommands, MoveToIsAcceptedStartedHalfWayAndCompletedWhereItWasSent) {
  go_standalone(State::Operational);
  const auto outcome = flight.craft().command("MANIPULATOR", "MOVE_TO", {-1.0, 1.9, 2.0});
  expect_done(outcome);
  EXPECT_EQ(outcome.progress_reports, 1);
  flight.craft().run(500ms);
  // With friction of 1 N m and kp of 4 x 300 N m/rad the joints stop within 1 mrad.
  const auto& q = flight.device<simulation::RobotDevice>("robot").arm().state().link_rad;
  EXPECT_NEAR(q[0], -1.0, 1e-3);
  EXPECT_NEAR(q[1], 1.9, 1e-3);
  EXPECT_TRUE(flight.story().has("MANIPULATOR info MOTION_DONE"));
}

TEST_F(Telecommands, AMotionIntoTheRailEndsByTheTorqueLimitSaysSoAndTheRobotIsSafe) {
  go_standalone(State::Operational);
  const auto outcome = flight.craft().command("MANIPULATOR", "MOVE_TO", {-0.5, 1.2, 2.0});
  EXPECT_TRUE(outcome.started);
  constexpr auto torque_tripped = static_cast<FailureCode>(0x8003);  // the manipulator's own
  expect_refused(outcome, torque_tripped, 8);
  EXPECT_TRUE(flight.run_until_state("MANIPULATOR", State::SafeOperational, 100ms));
  EXPECT_TRUE(flight.story().has("MANIPULATOR medium TORQUE_LIMIT_EXCEEDED"));
}

TEST_F(Telecommands, ASecondMotionIsRefusedAsBusyAndTheFirstGoesOn) {
  go_standalone(State::Operational);
  const auto first = function_packet(manipulator_apid, first_count, call_data("MOVE_TO", {-0.9, 1.7, 3.0}));
  flight.craft().ground().send(first);
  flight.craft().run(100ms);
  expect_refused(flight.craft().command("MANIPULATOR", "MOVE_TO", {-1.0, 1.9, 2.0}), FailureCode::Busy, 4);
  flight.craft().run(3s);
  EXPECT_TRUE(flight.story().has("MANIPULATOR info MOTION_DONE"));
}

TEST_F(Telecommands, AMotionThatIsCutShortEndsWithItsOwnFailureReport) {
  go_standalone(State::Operational);
  std::vector<int> subtypes;
  flight.story().on_telemetry = [&](const pus::TelemetryView& packet) {
    if (packet.service() == 1 && packet.apid() == manipulator_apid && packet.destination() == 0)
      subtypes.push_back(packet.subtype());
  };
  flight.craft().ground().send(function_packet(manipulator_apid, first_count, call_data("MOVE_TO", {-0.9, 1.7, 3.0})));
  flight.craft().run(100ms);
  flight.craft().ground().send(function_packet(manipulator_apid, first_count + 1, call_data("HOLD", {})));
  flight.craft().run(100ms);
  EXPECT_EQ(subtypes, (std::vector{1, 3, 1, 8, 3, 7}));
}

TEST_F(Telecommands, InTelepresenceMoveToIsRefusedForTheMode) {
  expect_refused(flight.craft().command("MANIPULATOR", "MOVE_TO", {-1.0, 1.9, 2.0}), FailureCode::WrongMode, 2);
}

TEST_F(Telecommands, OutsideOperationalMoveToIsRefusedForTheState) {
  go_standalone(State::SafeOperational);
  expect_refused(flight.craft().command("MANIPULATOR", "MOVE_TO", {-1.0, 1.9, 2.0}), FailureCode::WrongState, 2);
}

TEST_F(Telecommands, ATargetOutOfRangeFailsToStart) {
  go_standalone(State::Operational);
  expect_verdict(flight.send(function_packet(manipulator_apid, first_count, call_data("MOVE_TO", {5.0, 1.9, 2.0}))), 4,
                 0x0105, manipulator_apid);
}

TEST_F(Telecommands, AnUnknownFunctionFailsToStart) {
  expect_verdict(flight.send(function_packet(manipulator_apid, first_count, call_data("JUMP", {}))), 4, 0x0101,
                 manipulator_apid);
}

TEST_F(Telecommands, ApplicationDataOfAWrongLengthAreNotAccepted) {
  go_standalone(State::Operational);
  auto data = call_data("MOVE_TO", {-1.0, 1.9, 2.0});
  data.resize(data.size() - 3);
  expect_verdict(flight.send(function_packet(manipulator_apid, first_count, data)), 2, 8, manipulator_apid);
}

TEST_F(Telecommands, ADamagedPacketIsNotAccepted) {
  auto packet = function_packet(manipulator_apid, first_count, call_data("HOLD", {}));
  packet.back() ^= std::byte{1};
  expect_verdict(flight.send(packet), 2, 5, supervisor_apid);
}

TEST_F(Telecommands, AnUnknownAddresseeFailsToRoute) {
  expect_verdict(flight.send(function_packet(99, first_count, call_data("HOLD", {}))), 10, 1, supervisor_apid);
}

TEST_F(Telecommands, SafeOperationalIsRefusedWhileARequiredLinkIsAbsent) {
  expect_done(flight.set_mode("commissioning"));
  for (const State state : {State::SafeOperational, State::PostOperational, State::PreOperational})
    expect_done(flight.set_state("JOYSTICK", state));
  expect_done(flight.configure("JOYSTICK", "COUPLED"));
  expect_refused(flight.set_state("JOYSTICK", State::SafeOperational), FailureCode::LinkAbsent, 2);
  EXPECT_EQ(flight.state("JOYSTICK"), State::PreOperational);
}

TEST_F(Telecommands, WhatThePowerBudgetDoesNotCarryIsRefusedWithTheNumbersUntilItDoes) {
  take_out("MANIPULATOR");
  // Supervisor 12 W, communication 8 W, joystick 25 W; the manipulator wants 60 W.
  expect_done(flight.craft().command("SUPERVISOR", "SET_POWER_BUDGET", {104.9}));
  expect_refused(flight.set_state("MANIPULATOR", State::SafeOperational), FailureCode::PowerShort, 2);
  EXPECT_TRUE(flight.story().has("power short: MANIPULATOR asks for 60 W, 45 W of 104.9 W are reserved"));
  flight.craft().run(50ms);
  EXPECT_TRUE(flight.story().has("SUPERVISOR low POWER_REFUSED APID=10 BUDGET=104.9 W RESERVED=45 W REQUESTED=60 W"));
  EXPECT_EQ(flight.state("MANIPULATOR"), State::PreOperational);
  expect_done(flight.craft().command("SUPERVISOR", "SET_POWER_BUDGET", {105}));
  expect_done(flight.set_state("MANIPULATOR", State::SafeOperational));
  expect_done(flight.set_state("MANIPULATOR", State::Operational));
}

TEST_F(Telecommands, PowerIsFreeAgainOnceASubsystemIsBackInPreOperational) {
  take_out("MANIPULATOR");
  expect_done(flight.craft().command("SUPERVISOR", "SET_POWER_BUDGET", {81}));
  expect_refused(flight.set_state("MANIPULATOR", State::SafeOperational), FailureCode::PowerShort, 2);
  take_out("JOYSTICK");
  expect_done(flight.set_state("MANIPULATOR", State::SafeOperational));
  expect_refused(flight.set_state("JOYSTICK", State::SafeOperational), FailureCode::PowerShort, 2);
}

TEST_F(Telecommands, OfTwoThatAreAskedForAtOnceOnlyWhatFitsIsGranted) {
  take_out("MANIPULATOR");
  take_out("JOYSTICK");
  expect_done(flight.craft().command("SUPERVISOR", "SET_POWER_BUDGET", {104}));
  std::vector<std::byte> up = call_data("SET_STATE", {});
  up.back() = std::byte{1};
  for (const int octet : {1, static_cast<int>(State::SafeOperational)}) up.push_back(static_cast<std::byte>(octet));
  flight.craft().ground().send(function_packet(manipulator_apid, first_count, up));
  expect_verdict(flight.send(function_packet(joystick_apid, first_count + 1, up)), 2, 16, supervisor_apid);
  EXPECT_TRUE(flight.run_until_state("MANIPULATOR", State::SafeOperational, 1s));
}

/// What was granted and not yet carried out counts, and is taken back, when the budget falls.
TEST_F(Telecommands, ABudgetThatFallsInTheSameInstantTakesBackWhatWasJustGranted) {
  take_out("MANIPULATOR");
  std::vector<std::byte> up = call_data("SET_STATE", {});
  up.back() = std::byte{1};
  for (const int octet : {1, static_cast<int>(State::SafeOperational)}) up.push_back(static_cast<std::byte>(octet));
  flight.craft().ground().send(function_packet(manipulator_apid, first_count, up));
  expect_done(flight.craft().command("SUPERVISOR", "SET_POWER_BUDGET", {50}));
  EXPECT_TRUE(flight.story().has("power budget 50 W, 105 W are reserved")) << flight.story().text();
  EXPECT_TRUE(flight.run_until_state("MANIPULATOR", State::Offline, 1s)) << flight.story().text();
  EXPECT_TRUE(flight.run_until_state("JOYSTICK", State::Offline, 1s));
  flight.craft().run(1s);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::Offline);
}

TEST(PowerShort, IsToldOnceWhereTheMissionDoesNothingAboutIt) {
  Flight flight{{.edit = [](descriptor::Mission& mission) {
    mission.plans.insert(
        mission.plans.begin(),
        {.name = "bear-it", .severities = {}, .subsystem = {}, .event = "LOAD_SHED", .mode = {}, .at = {}});
  }}};
  ASSERT_TRUE(flight.commission());
  EXPECT_TRUE(flight.craft().command("SUPERVISOR", "SET_POWER_BUDGET", {50}).completed);
  flight.craft().run(1s);
  EXPECT_EQ(flight.story().count("SUPERVISOR high LOAD_SHED BUDGET=50 W RESERVED=105 W"), 1U);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::Operational);
}

TEST_F(Telecommands, ANetworkIsTakenApartAndMadeAgainFromGround) {
  auto& robot = flight.device<simulation::RobotDevice>("robot");
  expect_done(flight.set_mode("commissioning"));
  expect_done(flight.craft().command("SUPERVISOR", "UNLINK", {2}));
  flight.craft().run(50ms);
  EXPECT_EQ(flight.craft().supervisor().links().up_count(), 1U);
  EXPECT_FALSE(robot.active()) << "its required link is gone";
  constexpr std::array network{"MANIPULATOR", "JOYSTICK"};
  for (const char* name : network) {
    for (const State state : {State::SafeOperational, State::PostOperational, State::PreOperational})
      expect_done(flight.set_state(name, state));
    expect_done(flight.configure(name, "COUPLED"));
  }
  EXPECT_EQ(flight.craft().supervisor().links().up_count(), 0U);
  for (const double link : {1.0, 2.0}) expect_done(flight.craft().command("SUPERVISOR", "LINK", {link}));
  EXPECT_EQ(flight.craft().supervisor().links().up_count(), 2U);
  for (const State state : {State::SafeOperational, State::Operational})
    for (const char* name : network) expect_done(flight.set_state(name, state));
  flight.craft().run(50ms);
  EXPECT_TRUE(robot.active());
}

TEST_F(Telecommands, HoldFailsToStartWhileALinkOwnsTheSetpoint) {
  expect_refused(flight.craft().command("MANIPULATOR", "HOLD", {}), FailureCode::SetpointOwnedByLink, 4);
}

TEST_F(Telecommands, NothingRefusedReachesTheRobot) {
  const auto before = flight.device<simulation::RobotDevice>("robot").arm().state().link_rad;
  static_cast<void>(flight.craft().command("MANIPULATOR", "MOVE_TO", {-1.0, 1.9, 2.0}));
  static_cast<void>(flight.send(function_packet(manipulator_apid, first_count, call_data("JUMP", {}))));
  flight.craft().run(500ms);
  EXPECT_EQ(flight.device<simulation::RobotDevice>("robot").arm().state().link_rad, before);
}

}  // namespace
}  // namespace hirosco::testing
