// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// What the spacecraft does when something breaks: detection, reaction and the story in the log.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/devices/joystick/joystick_device.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "tests/integration/greedy.hpp"

namespace hirosco::testing {
namespace {

using simulation::JoystickDevice;
using simulation::RobotDevice;
using simulation::Vec2;

/// From detection, in the acting member's own cycles.
constexpr int most_cycles_to_safe = 5;

class Faults : public ::testing::Test {
 protected:
  explicit Faults(Plan plan = {.edit = hand_rests}) : flight{std::move(plan)} {}
  void SetUp() override {
    ASSERT_TRUE(flight.commission()) << flight.story().text();
    robot = &flight.device<RobotDevice>("robot");
    joystick = &flight.device<JoystickDevice>("joystick");
  }
  /// Puts the finger on the rail, so that the robot pushes and the hand feels it.
  void press() {
    ASSERT_TRUE(joystick->hand("cartesian 0.0226 0 1"));
    flight.craft().run(1500ms);
    ASSERT_GT(robot->arm().contact().normal_force_n, 20);
    ASSERT_TRUE(robot->active());
    ASSERT_GT(std::abs(joystick->motor_torque_n_m()[1]), 0.05);
  }
  /// Counts the manipulator's cycles from now on until its robot is off.
  void count_cycles_to_safe() {
    counting_ = true;
    cycles_to_safe = 0;
    flight.craft().on_cycle([this](std::string_view subsystem, TimePoint) {
      if (!counting_ || subsystem != "MANIPULATOR") return;
      if (!robot->active()) counting_ = false;
      else ++cycles_to_safe;
    });
  }
  [[nodiscard]] bool robot_became_safe() const {
    ::testing::Test::RecordProperty("cycles_to_safe", cycles_to_safe);
    return !counting_;
  }
  bool answers_ping(std::uint16_t apid) {
    std::array<std::byte, max_packet_octets> buffer;
    const auto packet = pus::write_telecommand(
        buffer, {.apid = apid, .sequence_count = 9999, .ack = pus::ack_all, .service = 17, .subtype = 1, .source = 0},
        {});
    return packet && flight.send(*packet).subtype == 7;
  }

  Flight flight;
  RobotDevice* robot{nullptr};
  JoystickDevice* joystick{nullptr};
  int cycles_to_safe{0};

 private:
  bool counting_{false};
};

// --- a process dies ----------------------------------------------------------------------------------------------------

TEST_F(Faults, ADeadJoystickStopsTheRobotWithinFiveOfItsCycles) {
  press();
  flight.craft().run(700us);  // not at a step of the supervisor
  count_cycles_to_safe();
  flight.craft().kill("JOYSTICK");
  flight.craft().run(100ms);
  ASSERT_TRUE(robot_became_safe());
  // Counted from the death itself: the age limit of three cycles is in it.
  EXPECT_LE(cycles_to_safe, most_cycles_to_safe);
}

TEST_F(Faults, ADeadJoystickTakesItsNetworkDownWithinTwoSeconds) {
  press();
  const TimePoint killed = flight.craft().now();
  flight.craft().kill("JOYSTICK");
  ASSERT_TRUE(flight.run_until_state("MANIPULATOR", State::Offline, 5s)) << flight.story().text();
  EXPECT_LE(flight.craft().now() - killed, 2s);
  EXPECT_EQ(flight.state("JOYSTICK"), State::Offline);
  EXPECT_FALSE(robot->active());
  EXPECT_EQ(flight.craft().supervisor().links().up_count(), 0u);
}

TEST_F(Faults, TheRestLivesOnAfterADeath) {
  flight.craft().kill("JOYSTICK");
  flight.craft().run(2s);
  EXPECT_EQ(flight.state("COMMUNICATION"), State::Operational);
  EXPECT_TRUE(answers_ping(2));
  EXPECT_TRUE(answers_ping(1));
  EXPECT_TRUE(answers_ping(10)) << "the manipulator's process is Offline, not gone";
  EXPECT_EQ(flight.state("JOYSTICK"), State::Offline);
  EXPECT_TRUE(answers_ping(11)) << "its plan has started it again";
}

TEST_F(Faults, TheLogTellsOfADeathInOrder) {
  flight.craft().kill("JOYSTICK");
  flight.craft().run(2s);
  EXPECT_EQ(
      flight.story().missing_in_order(
          {"JOYSTICK died: signal 9", "plan died: network {MANIPULATOR, JOYSTICK} to ErrorOperational and down",
           "MANIPULATOR info STATE_CHANGED STATE=ErrorOperational",
           "MANIPULATOR info STATE_CHANGED STATE=PostOperational",
           "MANIPULATOR info STATE_CHANGED STATE=HardwareDeinit", "MANIPULATOR info STATE_CHANGED STATE=SoftwareDeinit",
           "MANIPULATOR info STATE_CHANGED STATE=Offline", "MANIPULATOR is Offline"}),
      "")
      << flight.story().text();
  EXPECT_TRUE(flight.story().has("SUPERVISOR high PROCESS_DIED"));
  EXPECT_EQ(flight.story().count("plan died"), 1u) << "one plan for one death";
  // Numbers and times of the records rise with the story.
  const auto records = flight.records();
  EXPECT_TRUE(std::ranges::is_sorted(records, {}, &supervisor::LogRecord::number));
  EXPECT_TRUE(std::ranges::is_sorted(records, {}, &supervisor::LogRecord::monotonic));
}

/// The robot would hold its last setpoint: only the supervisor is left to stop it.
class FaultsUnderHold : public Faults {
 protected:
  FaultsUnderHold()
      : Faults{{.edit = [](descriptor::Mission& mission) {
          hand_rests(mission);
          for (auto& member : mission.subsystems)
            for (auto& configuration : member.subsystem.configurations)
              for (auto& wanted : configuration.requires_) wanted.missing = descriptor::MissingPolicy::Hold;
        }}} {}
};

TEST_F(FaultsUnderHold, TheSupervisorStopsTheRobotWithinFiveCyclesOfSeeingTheDeath) {
  press();
  flight.story().on_line = [this](std::string_view line) {
    if (line.find("JOYSTICK died") == line.npos) return;
    EXPECT_TRUE(robot->active()) << "something else stopped it before: this test shows nothing";
    count_cycles_to_safe();
  };
  flight.craft().kill("JOYSTICK");
  flight.craft().run(100ms);
  ASSERT_TRUE(robot_became_safe());
  EXPECT_LE(cycles_to_safe, most_cycles_to_safe);
  EXPECT_TRUE(flight.story().has("JOYSTICK died")) << flight.story().text();
}

// --- a process stands still --------------------------------------------------------------------------------------------

TEST_F(Faults, AHungJoystickIsFoundAndItsNetworkGoesDown) {
  press();
  count_cycles_to_safe();
  flight.craft().stop("JOYSTICK", true);
  ASSERT_TRUE(flight.run_until_state("MANIPULATOR", State::Offline, 2s)) << flight.story().text();
  EXPECT_LE(cycles_to_safe, most_cycles_to_safe);
  EXPECT_EQ(flight.story().missing_in_order(
                {"JOYSTICK hangs: its cycle stands still", "plan network-down", "MANIPULATOR is Offline"}),
            "")
      << flight.story().text();
  EXPECT_TRUE(flight.story().has("SUPERVISOR high HANG"));
  EXPECT_FALSE(joystick->active()) << "its device's watchdog let go";
}

TEST_F(Faults, AHungJoystickThatGoesOnFindsItselfFenced) {
  press();
  flight.craft().stop("JOYSTICK", true);
  ASSERT_TRUE(flight.run_until_state("MANIPULATOR", State::Offline, 2s));
  EXPECT_TRUE(flight.craft().guard().fenced(11));
  int active_cycles = 0;
  flight.craft().on_cycle([&](std::string_view, TimePoint) { active_cycles += joystick->active() ? 1 : 0; });
  flight.craft().stop("JOYSTICK", false);
  flight.craft().run(2s);
  EXPECT_EQ(active_cycles, 0) << "it went on as if nothing had happened";
  EXPECT_EQ(flight.state("JOYSTICK"), State::Offline) << flight.story().text();
}

// --- a device fails ----------------------------------------------------------------------------------------------------

TEST(DeviceFaults, ADeviceThatIsGoneSilentFrozenGarbledOrLateTakesTheNetworkDown) {
  for (const char* line : {"unplug", "silent", "freeze 60000", "corrupt 1000000", "delay 100"}) {
    for (const auto& [device, event] :
         {std::pair{"joystick", "JOYSTICK high JOYSTICK_LOST"}, {"robot", "MANIPULATOR high ROBOT_LOST"}}) {
      Flight flight{{}};
      ASSERT_TRUE(flight.commission());
      flight.craft().run(500ms);
      const TimePoint injected = flight.craft().now();
      ASSERT_TRUE(flight.craft().device(device)->fault(line)) << line;
      ASSERT_TRUE(flight.run_until_state("MANIPULATOR", State::Offline, 3s)) << device << " " << line;
      ASSERT_TRUE(flight.run_until_state("JOYSTICK", State::Offline, 3s)) << device << " " << line;
      EXPECT_LE(flight.craft().now() - injected, 2s) << device << " " << line;
      EXPECT_TRUE(flight.story().has(event)) << device << " " << line << "\n" << flight.story().text();
      EXPECT_EQ(flight.state("COMMUNICATION"), State::Operational);
    }
  }
}

TEST(DeviceFaults, TwoBadFramesAreNoReason) {
  for (const char* line : {"corrupt 2", "stall 1", "freeze 1"}) {
    for (const char* device : {"joystick", "robot"}) {
      Flight flight{{}};
      ASSERT_TRUE(flight.commission());
      flight.craft().run(500ms);
      ASSERT_TRUE(flight.craft().device(device)->fault(line)) << line;
      flight.craft().run(1s);
      EXPECT_EQ(flight.state("MANIPULATOR"), State::Operational) << device << " " << line;
      EXPECT_EQ(flight.state("JOYSTICK"), State::Operational) << device << " " << line;
      EXPECT_FALSE(flight.story().has("plan ")) << device << " " << line;
    }
  }
}

// --- SAFE_ALL ----------------------------------------------------------------------------------------------------------

TEST_F(Faults, SafeAllStopsEveryActuatorWithinFiveCyclesInAMotion) {
  ASSERT_TRUE(joystick->hand("sine 1 0.15 0.5"));
  flight.craft().run(1s);
  flight.story().on_line = [this](std::string_view line) {
    if (line.starts_with("SAFE_ALL")) count_cycles_to_safe();
  };
  const auto outcome = flight.craft().command("SUPERVISOR", "SAFE_ALL", {});
  EXPECT_TRUE(outcome.completed);
  flight.craft().run(100ms);
  ASSERT_TRUE(robot_became_safe());
  EXPECT_LE(cycles_to_safe, most_cycles_to_safe);
  EXPECT_FALSE(joystick->active());
  // By shared memory, before and beside any telecommand.
  EXPECT_NE(flight.inhibited("MANIPULATOR") & inhibited_by_stop, 0U);
  EXPECT_NE(flight.inhibited("JOYSTICK") & inhibited_by_stop, 0U);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::SafeOperational);
  EXPECT_EQ(flight.state("JOYSTICK"), State::SafeOperational);
  EXPECT_EQ(flight.state("COMMUNICATION"), State::Operational) << "the ground link is needed now more than ever";
}

TEST_F(Faults, AfterSafeAllTheOperatorBringsTheCraftBack) {
  ASSERT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed);
  flight.craft().run(100ms);
  ASSERT_TRUE(flight.set_state("JOYSTICK", State::Operational).completed);
  ASSERT_TRUE(flight.set_state("MANIPULATOR", State::Operational).completed);
  flight.craft().run(100ms);
  EXPECT_TRUE(robot->active());
  EXPECT_TRUE(joystick->active());
}

// --- events by severity ------------------------------------------------------------------------------------------------

TEST_F(Faults, AMediumEventBringsItsSubsystemToSafeOperationalAndNobodyElse) {
  press();
  ASSERT_TRUE(robot->fault("temperature 1 72"));
  ASSERT_TRUE(flight.run_until_state("MANIPULATOR", State::SafeOperational, 1s)) << flight.story().text();
  EXPECT_EQ(
      flight.story().missing_in_order({"MANIPULATOR medium TEMPERATURE_CRITICAL",
                                       "plan to-safe: MANIPULATOR to SafeOperational because of TEMPERATURE_CRITICAL"}),
      "")
      << flight.story().text();
  flight.craft().run(100ms);
  EXPECT_FALSE(robot->active());
  EXPECT_EQ(flight.state("JOYSTICK"), State::Operational);
  EXPECT_EQ(joystick->motor_torque_n_m(), Vec2{}) << "the link says that the robot is not active";
}

TEST_F(Faults, ALowEventIsOnlyLogged) {
  press();
  ASSERT_TRUE(robot->fault("temperature 1 56"));
  flight.craft().run(1s);
  EXPECT_TRUE(flight.story().has("MANIPULATOR low TEMPERATURE_WARNING")) << flight.story().text();
  EXPECT_FALSE(flight.story().has("plan "));
  EXPECT_EQ(flight.state("MANIPULATOR"), State::Operational);
  EXPECT_TRUE(robot->active());
}

class GreedyFaults : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(flight.commission()) << flight.story().text(); }
  GreedyTrace trace;
  Flight flight{greedy_plan(trace)};
};

TEST_F(GreedyFaults, TwoMediumEventsInOneCycleRunOnePlan) {
  ASSERT_TRUE(flight.craft().command("GREEDY", "TWO_TROUBLES", {}).completed);
  ASSERT_TRUE(flight.run_until_state("GREEDY", State::SafeOperational, 1s));
  flight.craft().run(200ms);
  EXPECT_TRUE(flight.story().has("GREEDY medium TROUBLE"));
  EXPECT_TRUE(flight.story().has("GREEDY medium MORE_TROUBLE"));
  EXPECT_EQ(flight.story().count("plan to-safe: "), 1u) << flight.story().text();
  EXPECT_EQ(flight.story().count("GREEDY info STATE_CHANGED STATE=SafeOperational"), 2u)
      << "once while commissioning, once by the plan";
}

TEST_F(GreedyFaults, AnUnpluggedMotorTakesItsSubsystemDown) {
  ASSERT_TRUE(flight.craft().device("motor")->fault("unplug"));
  ASSERT_TRUE(flight.run_until_state("GREEDY", State::Offline, 2s)) << flight.story().text();
  EXPECT_EQ(flight.story().missing_in_order(
                {"GREEDY high MOTOR_LOST", "plan network-down: network {GREEDY}", "GREEDY is Offline"}),
            "");
}

// --- the supervisor itself ---------------------------------------------------------------------------------------------

TEST_F(Faults, SubsystemsMakeThemselvesSafeWhenTheSupervisorFallsSilent) {
  press();
  flight.craft().stop("SUPERVISOR", true);
  flight.craft().run(40ms);
  EXPECT_TRUE(robot->active()) << "a short silence is none";
  flight.craft().run(60ms);
  EXPECT_FALSE(robot->active()) << "its second inhibit is held by nobody any more";
  flight.craft().run(1800ms);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::Operational) << "the subsystem itself waits longer";
  flight.craft().run(200ms);
  EXPECT_EQ(flight.state("MANIPULATOR"), State::ErrorOperational);
  EXPECT_EQ(flight.state("JOYSTICK"), State::ErrorOperational);
  EXPECT_FALSE(robot->active());
  EXPECT_FALSE(joystick->active());
}

TEST_F(Faults, ARobotThatIsStoppedByItsNeighboursDeathNeedsNoSupervisor) {
  press();
  flight.craft().stop("SUPERVISOR", true);
  count_cycles_to_safe();
  flight.craft().kill("JOYSTICK");
  flight.craft().run(100ms);
  ASSERT_TRUE(robot_became_safe());
  EXPECT_LE(cycles_to_safe, most_cycles_to_safe);
  EXPECT_NE(flight.inhibited("MANIPULATOR") & inhibited_by_link, 0u);
}

// --- the end -----------------------------------------------------------------------------------------------------------

TEST_F(Faults, AnOrderlyShutdownLeavesNothingRunning) {
  press();
  flight.craft().supervisor().request_shutdown();
  flight.craft().run(5s);
  EXPECT_TRUE(flight.craft().supervisor().finished());
  EXPECT_TRUE(flight.craft().supervisor().succeeded()) << flight.story().text();
  for (const char* name : {"MANIPULATOR", "JOYSTICK", "COMMUNICATION"})
    EXPECT_EQ(flight.state(name), State::Offline) << name;
  EXPECT_FALSE(robot->active());
}

}  // namespace
}  // namespace hirosco::testing
