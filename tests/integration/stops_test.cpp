// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// That a stop cannot be defeated, that who hangs is ended and who dies comes back, and that what was stopped can be brought
// up again (docs/adr/0018).
#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/devices/joystick/joystick_device.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using pus::FailureCode;
using simulation::JoystickDevice;
using simulation::RobotDevice;

constexpr std::uint16_t robot_apid = 10;

class Stops : public ::testing::Test {
 protected:
  explicit Stops(Plan plan = {.edit = hand_rests}) : flight{std::move(plan)} {}
  void SetUp() override {
    ASSERT_TRUE(flight.commission()) << flight.story().text();
    robot = &flight.device<RobotDevice>("robot");
    joystick = &flight.device<JoystickDevice>("joystick");
  }
  void press() {
    ASSERT_TRUE(joystick->hand("cartesian 0.0226 0 1"));
    flight.craft().run(1500ms);
    ASSERT_GT(robot->arm().contact().normal_force_n, 20);
  }
  /// The one bring-up of an operator: the commissioning list of telepresence by telecommands.
  [[nodiscard]] ::testing::AssertionResult bring_up() {
    const auto each = [&](auto&& act) {
      for (const char* subsystem : {"MANIPULATOR", "JOYSTICK"})
        if (const auto outcome = act(subsystem); !outcome.completed)
          return ::testing::AssertionFailure()
                 << subsystem << ": " << (outcome.failure ? to_text(*outcome.failure) : "no answer") << '\n'
                 << flight.story().text();
      return ::testing::AssertionSuccess();
    };
    if (auto done = each([&](auto name) { return flight.set_state(name, State::PreOperational); }); !done) return done;
    if (auto done = each([&](auto name) { return flight.configure(name, "COUPLED"); }); !done) return done;
    for (const double link : {1.0, 2.0})
      if (!flight.craft().command("SUPERVISOR", "LINK", {link}).completed)
        return ::testing::AssertionFailure() << "link " << link;
    if (auto done = each([&](auto name) { return flight.set_state(name, State::SafeOperational); }); !done) return done;
    return each([&](auto name) { return flight.set_state(name, State::Operational); });
  }
  [[nodiscard]] bool coupled() {
    return flight.state("MANIPULATOR") == State::Operational && flight.state("JOYSTICK") == State::Operational &&
           robot->active() && joystick->active();
  }
  void open_for_bring_up() { ASSERT_TRUE(flight.set_mode("commissioning").completed); }

  Flight flight;
  RobotDevice* robot{nullptr};
  JoystickDevice* joystick{nullptr};
};

// --- SF1 ---------------------------------------------------------------------------------------------------------------

TEST_F(Stops, NobodyOnGroundChangesTheSupervisorsOwnStateOrConfiguration) {
  for (const State state : {State::Offline, State::PreOperational, State::SafeOperational, State::ErrorOperational,
                            State::PostOperational}) {
    const auto outcome = flight.set_state("SUPERVISOR", state);
    EXPECT_EQ(outcome.failure, FailureCode::WrongMode) << to_text(state);
  }
  EXPECT_EQ(flight.craft().command("SUPERVISOR", "CONFIGURE", {1}).failure, FailureCode::WrongMode);
  EXPECT_EQ(flight.craft().supervisor().own_state(), State::Operational);
}

TEST_F(Stops, SafeAllIsCarriedOutWhateverStateTheSupervisorItselfIsIn) {
  press();
  // Only the supervisor itself can bring itself down: here a test stands for whatever may do so one day.
  const auto& engine = flight.craft().supervisor();
  ASSERT_EQ(engine.own_state(), State::Operational);
  const auto outcome = flight.craft().command("SUPERVISOR", "SAFE_ALL", {});
  EXPECT_TRUE(outcome.accepted && outcome.completed);
  EXPECT_FALSE(robot->active());
  EXPECT_FALSE(joystick->active());
}

// --- SF4 ---------------------------------------------------------------------------------------------------------------

TEST_F(Stops, AStopOfEverythingIsNotLiftedByARefusedCommandToGoOn) {
  press();
  ASSERT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed);
  // To the supervisor it is permitted no more, as the robot is Safe-Operational with its links up; to a busy robot it is
  // refused by itself: neither may leave a permission behind.
  const auto epoch = flight.craft().guard().fences(robot_apid);
  EXPECT_FALSE(flight.craft().guard().release(robot_apid, epoch - 1));
  EXPECT_TRUE(flight.craft().guard().fenced(robot_apid));
  flight.craft().run(3s);
  EXPECT_FALSE(robot->active());
}

// --- SF2 ---------------------------------------------------------------------------------------------------------------

TEST_F(Stops, ACycleThatSpinsLosesTheProcessorIsStoppedAndEnded) {
  press();
  flight.craft().spin("JOYSTICK");
  flight.craft().run(150ms);
  const auto held_up = flight.cycles("MANIPULATOR");
  flight.craft().run(40ms);
  EXPECT_EQ(flight.cycles("MANIPULATOR"), held_up) << "one processor for all cycles";
  flight.craft().run(100ms);
  EXPECT_GT(flight.cycles("COMMUNICATION"), 0u);
  EXPECT_TRUE(flight.story().has("JOYSTICK hangs: its cycle stands still"));
  EXPECT_FALSE(flight.story().has("MANIPULATOR hangs")) << flight.story().text();
  EXPECT_FALSE(robot->active());
  EXPECT_FALSE(joystick->active());
  flight.craft().run(1500ms);
  EXPECT_TRUE(flight.story().has("JOYSTICK was ended"));
  EXPECT_TRUE(flight.story().has("JOYSTICK died: signal 9"));
  EXPECT_EQ(flight.state("MANIPULATOR"), State::Offline);
  EXPECT_EQ(flight.state("COMMUNICATION"), State::Operational) << "nobody outside the network is harmed";
}

TEST_F(Stops, AServiceLoopThatStandsStillIsStoppedAndEnded) {
  press();
  flight.craft().stick("MANIPULATOR", true);
  flight.craft().run(supervisor::Guard::service_limit + 50ms);
  EXPECT_TRUE(flight.story().has("MANIPULATOR hangs: its service loop stands still"));
  EXPECT_FALSE(robot->active());
  flight.craft().run(1500ms);
  EXPECT_TRUE(flight.story().has("MANIPULATOR was ended"));
}

// --- SF5 ---------------------------------------------------------------------------------------------------------------

TEST_F(Stops, ADeathDuringAPlanStillTakesTheNetworkDown) {
  press();
  ASSERT_TRUE(joystick->fault("unplug"));
  ASSERT_TRUE(flight.craft().run_until([&] { return flight.story().has("JOYSTICK high JOYSTICK_LOST"); }, 1s));
  flight.craft().kill("JOYSTICK");
  flight.craft().run(2s);
  EXPECT_TRUE(flight.story().has("SUPERVISOR high PROCESS_DIED"));
  EXPECT_FALSE(robot->active());
  EXPECT_EQ(flight.state("MANIPULATOR"), State::Offline);
}

// --- SF12 --------------------------------------------------------------------------------------------------------------

TEST_F(Stops, ShutdownIsCarriedOutAtOnce) {
  EXPECT_TRUE(flight.craft().command("SUPERVISOR", "SHUTDOWN", {}, 100ms).accepted);
  flight.craft().run(1s);
  EXPECT_TRUE(flight.craft().supervisor().finished());
}

// --- SF14 --------------------------------------------------------------------------------------------------------------

TEST_F(Stops, WhatAnUnplugStoppedIsBroughtUpAgainByOneBringUpTenTimes) {
  open_for_bring_up();
  for (int time = 1; time <= 10; ++time) {
    ASSERT_TRUE(coupled()) << time;
    ASSERT_TRUE(joystick->fault("unplug"));
    ASSERT_TRUE(flight.run_until_state("MANIPULATOR", State::Offline, 2s)) << time;
    ASSERT_TRUE(flight.run_until_state("JOYSTICK", State::Offline, 2s)) << time;
    EXPECT_FALSE(robot->active());
    // One that was exchanged or switched off meanwhile knows nothing, and is told that it is off before it is to move.
    if (time % 2 == 0) {
      ASSERT_TRUE(joystick->fault("reboot"));
    }
    ASSERT_TRUE(joystick->fault("plug"));
    flight.craft().run(100ms);
    ASSERT_TRUE(bring_up()) << time;
    flight.craft().run(500ms);
  }
  EXPECT_TRUE(coupled());
}

// --- R50 ---------------------------------------------------------------------------------------------------------------

TEST_F(Stops, ADeviceThatRebootsInAMotionMovesNothingByItselfIsLostAsLetGoAndFliesAgain) {
  open_for_bring_up();
  for (const std::string_view device : {"robot", "joystick", "robot"}) {
    ASSERT_TRUE(joystick->hand("sine 2 0.05 0.5"));
    flight.craft().run(800ms);
    ASSERT_TRUE(coupled()) << device;
    simulation::SimulatedDevice& rebooted = *flight.craft().device(device);
    ASSERT_TRUE(rebooted.fault("reboot"));
    int acted = 0;
    ASSERT_TRUE(flight.craft().run_until(
        [&] {
          acted += rebooted.active() ? 1 : 0;
          return flight.state("MANIPULATOR") == State::Offline && flight.state("JOYSTICK") == State::Offline;
        },
        2s))
        << device;
    EXPECT_EQ(acted, 0) << device;
    EXPECT_TRUE(rebooted.watchdog_tripped()) << device;
    EXPECT_TRUE(flight.story().has(device == "robot" ? "ROBOT_LOST REASON=watchdog let go"
                                                     : "JOYSTICK_LOST REASON=watchdog let go"))
        << flight.story().text();
    ASSERT_TRUE(bring_up()) << device;
    flight.craft().run(300ms);
    EXPECT_TRUE(coupled()) << device;
  }
}

// --- SF15 --------------------------------------------------------------------------------------------------------------

TEST_F(Stops, WhoDiedIsBackOfflineInTwoSecondsAndOneBringUpCouplesAgain) {
  open_for_bring_up();
  for (const char* victim : {"JOYSTICK", "MANIPULATOR", "JOYSTICK"}) {
    ASSERT_TRUE(coupled()) << victim;
    flight.craft().kill(victim);
    flight.craft().run(2s);
    ASSERT_NE(flight.craft().subsystem(victim), nullptr) << victim;
    EXPECT_EQ(flight.state(victim), State::Offline);
    ASSERT_TRUE(bring_up()) << victim;
    flight.craft().run(200ms);
  }
  EXPECT_TRUE(coupled());
}

TEST_F(Stops, AGroundLinkThatDiedComesBackToWhatItWas) {
  flight.craft().kill("COMMUNICATION");
  ASSERT_TRUE(flight.run_until_state("COMMUNICATION", State::Operational, 3s)) << flight.story().text();
  EXPECT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed);
}

/// It was ordered to rest before anybody saw that it spins: the order makes nobody blind.
TEST_F(Stops, ACycleThatSpinsWhenItIsToRestIsEndedAndComesBack) {
  open_for_bring_up();
  ASSERT_TRUE(flight.set_state("JOYSTICK", State::SafeOperational).completed);
  flight.craft().spin("JOYSTICK");
  static_cast<void>(flight.set_state("JOYSTICK", State::PostOperational));
  flight.craft().run(3s);
  ASSERT_NE(flight.craft().subsystem("JOYSTICK"), nullptr);
  for (const char* other : {"MANIPULATOR"})
    for (const State state : {State::SafeOperational, State::PostOperational, State::PreOperational})
      if (flight.state(other) != State::Offline) static_cast<void>(flight.set_state(other, state));
  EXPECT_TRUE(bring_up());
}

TEST_F(Stops, AGroundLinkThatATelecommandClosedComesBackByItself) {
  open_for_bring_up();
  for (const State state : {State::SafeOperational, State::PostOperational})
    ASSERT_TRUE(flight.set_state("COMMUNICATION", state).completed) << to_text(state);
  static_cast<void>(flight.set_state("COMMUNICATION", State::Offline));
  ASSERT_TRUE(flight.story().has("COMMUNICATION info STATE_CHANGED STATE=Offline")) << flight.story().text();
  ASSERT_TRUE(flight.run_until_state("COMMUNICATION", State::Operational, 3s)) << flight.story().text();
  EXPECT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed);
}

/// In Pre-Operational it listens to nobody either until a configuration is in force.
TEST_F(Stops, AGroundLinkThatATelecommandLeftWithoutConfigurationComesBackByItself) {
  open_for_bring_up();
  const auto send = [&](State state, Duration limit) {
    static_cast<void>(flight.craft().command("COMMUNICATION", "SET_STATE", {static_cast<double>(state)}, limit));
  };
  send(State::SafeOperational, 50ms);
  send(State::PostOperational, 50ms);
  send(State::Offline, 10ms);  // there it hears nobody: the next is on its way before
  send(State::PreOperational, 100ms);
  ASSERT_EQ(flight.state("COMMUNICATION"), State::PreOperational);
  ASSERT_TRUE(flight.run_until_state("COMMUNICATION", State::Operational, 3s)) << flight.story().text();
  EXPECT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed);
}

TEST_F(Stops, AGroundLinkThatDiesAgainAndAgainComesBackAgainAndAgain) {
  for (int death = 1; death <= 8; ++death) {
    flight.craft().kill("COMMUNICATION");
    ASSERT_TRUE(flight.run_until_state("COMMUNICATION", State::Operational, 12s)) << death << flight.story().text();
    EXPECT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed) << death;
  }
}

/// "What a fault stopped can be brought up again, every time": the plan starts three times in a minute, the ground as often as it asks.
TEST_F(Stops, WhoDiedTooOftenIsStartedByTheGroundAndOneBringUpCouplesAgain) {
  open_for_bring_up();
  const auto down = [&] { return !flight.craft().subsystem("JOYSTICK"); };
  for (int death = 1; death <= 4; ++death) {
    flight.craft().kill("JOYSTICK");
    flight.craft().run(3s);
  }
  ASSERT_TRUE(flight.story().has("JOYSTICK stays down")) << flight.story().text();
  for (int time = 1; time <= 3; ++time) {
    ASSERT_TRUE(down()) << time;
    EXPECT_EQ(flight.set_state("JOYSTICK", State::PreOperational).failure, FailureCode::UnknownApid);
    ASSERT_TRUE(flight.set_state("JOYSTICK", State::Offline).completed) << flight.story().text();
    ASSERT_TRUE(bring_up()) << time;
    flight.craft().run(200ms);
    EXPECT_TRUE(coupled()) << time;
    flight.craft().kill("JOYSTICK");
    flight.craft().run(3s);
  }
}

TEST_F(Stops, AModeWhoseMembersAreDeadIsRefused) {
  open_for_bring_up();
  flight.craft().kill("JOYSTICK");
  flight.craft().run(20ms);
  EXPECT_EQ(flight.set_mode("telepresence").failure, FailureCode::WrongStatus);
}

/// Who stands still is not waited for, and what it was asked has an end all the same, before the ground link goes.
TEST_F(Stops, WhatWasAskedOfWhoStandsStillAtShutdownEndsWithOutcomeUnknown) {
  ASSERT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed);
  for (const State state : {State::SafeOperational, State::PostOperational, State::Offline})
    static_cast<void>(flight.set_state("JOYSTICK", state));
  ASSERT_EQ(flight.state("JOYSTICK"), State::Offline);
  std::vector<std::uint16_t> codes;
  flight.story().on_telemetry = [&](const pus::TelemetryView& report) {
    if (report.service() != 1 || report.subtype() != 8) return;
    OctetReader reader{report.source_data()};
    static_cast<void>(reader.get<std::uint32_t>());
    codes.push_back(reader.get<std::uint16_t>());
  };
  flight.craft().stop("JOYSTICK", true);
  const auto asked =
      flight.craft().command("JOYSTICK", "SET_STATE", {static_cast<double>(State::PreOperational)}, 50ms);
  ASSERT_FALSE(asked.completed);
  ASSERT_FALSE(flight.craft().supervisor().finished());
  flight.craft().supervisor().request_shutdown();
  flight.craft().run(6s);
  ASSERT_TRUE(flight.craft().supervisor().finished());
  EXPECT_TRUE(flight.craft().supervisor().succeeded());
  EXPECT_EQ(codes, std::vector{static_cast<std::uint16_t>(FailureCode::OutcomeUnknown)});
}

TEST_F(Stops, AMotionWhoseSubsystemDiesEndsWithOutcomeUnknown) {
  open_for_bring_up();
  for (const State state : {State::SafeOperational, State::PostOperational, State::PreOperational})
    ASSERT_TRUE(flight.set_state("MANIPULATOR", state).completed) << to_text(state);
  ASSERT_TRUE(flight.configure("MANIPULATOR", "STANDALONE").completed);
  ASSERT_TRUE(flight.enter_mode("standalone").completed);
  for (const State state : {State::SafeOperational, State::Operational})
    ASSERT_TRUE(flight.set_state("MANIPULATOR", state).completed) << to_text(state);
  const auto packet = function_packet(robot_apid, 77, call_data("MOVE_TO", {0.0, 1.2, 5.0}));
  bool started = false;
  flight.story().on_telemetry = [&](const pus::TelemetryView& report) {
    if (report.service() != 1 || report.subtype() != 3 || started) return;
    started = true;
  };
  flight.craft().ground().send(packet);
  ASSERT_TRUE(flight.craft().run_until([&] { return started; }, 1s));
  std::vector<std::uint16_t> codes;
  flight.story().on_telemetry = [&](const pus::TelemetryView& report) {
    if (report.service() != 1 || report.subtype() != 8) return;
    OctetReader reader{report.source_data()};
    static_cast<void>(reader.get<std::uint32_t>());
    codes.push_back(reader.get<std::uint16_t>());
  };
  flight.craft().kill("MANIPULATOR");
  flight.craft().run(1s);
  EXPECT_EQ(std::ranges::count(codes, static_cast<std::uint16_t>(FailureCode::OutcomeUnknown)), 1);
}

// --- a way up -----------------------------------------------------------------------------------------------------------

TEST(CommissioningThatIsCrossed, ByARecoveryIsNotToldAsDone) {
  Flight flight{{.edit = hand_rests}};
  ASSERT_TRUE(flight.craft().run_until([&] { return flight.story().has("link 2 "); }, 1s));
  ASSERT_TRUE(flight.device<JoystickDevice>("joystick").fault("unplug"));
  flight.craft().run(3s);
  EXPECT_FALSE(flight.story().has("commissioned: mode telepresence")) << flight.story().text();
  EXPECT_TRUE(flight.story().has("commissioning stopped")) << flight.story().text();
}

}  // namespace
}  // namespace hirosco::testing
