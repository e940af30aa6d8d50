// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/power_frame.hpp"
#include "hirosco/data_transfer/device/testing/sealed.hpp"
#include "supervisor/guard/testing/guard_rig.hpp"

/// When the devices of a member have power, judged at the switch: the test plays it.
namespace hirosco::supervisor {
namespace {

using namespace testing;

/// ARM's motor has a switch; the one of the test answers what it is told.
struct PowerTest : GuardTest {
  PowerTest() {
    descriptor::Endnode endnode;
    endnode.address = "motor-power";
    mission.subsystems[0].subsystem.power_switches = {{"MOTOR", endnode, {}}};
  }
  void SetUp() override {
    GuardTest::SetUp();
    power = flows.open({Transfer::SharedMemory, "motor-power"}, FlowSide::Device).value();
  }
  /// What it was told in this time, by the guard's steps; empty: nothing, or not always the same.
  std::optional<bool> told_in(Duration span, std::optional<DeviceOutput> output = DeviceOutput::Off) {
    std::optional<bool> all;
    bool same = true;
    for (const TimePoint end = clock.now() + span; clock.now() < end;) {
      run(Guard::period, {arm, hand, camera}, output);
      const auto command = hear();
      if (!command) return std::nullopt;
      same = same && (!all || *all == command->on);
      all = command->on;
    }
    return same ? all : std::nullopt;
  }
  std::optional<PowerCommand> hear() {
    std::array<std::byte, power_frame_octets> frame;
    const auto received = power->receive(frame);
    if (!received || received->flow != Flow::New) return std::nullopt;
    const auto command = read_power_command(frame).value();
    sequences.push_back(command.sequence);
    if (answers) static_cast<void>(power->send(*write_power_status(frame, {command.on, command.sequence})));
    return command;
  }
  void enter(State state) { lives[arm].vital->state = static_cast<std::uint32_t>(state); }
  [[nodiscard]] std::uint32_t said() { return lives[arm].permit->powered.load(); }

  std::unique_ptr<DataFlow> power;
  bool answers{true};
  std::vector<std::uint32_t> sequences;
};

TEST_F(PowerTest, ADeviceHasPowerFromHardwareInitToHardwareDeinitAndInNoOtherState) {
  using enum State;
  for (const State state : {Offline, SoftwareInit, HardwareInit, PreOperational, SafeOperational, Operational,
                            ErrorOperational, PostOperational, HardwareDeinit, SoftwareDeinit, Offline}) {
    enter(state);
    const bool on = state != Offline && state != SoftwareInit && state != SoftwareDeinit;
    EXPECT_EQ(told_in(20ms), on) << to_text(state);
    EXPECT_EQ(said(), on ? power_on : power_off) << to_text(state);
  }
}

TEST_F(PowerTest, ThePageSaysWhatTheSwitchHasSaidAndNotWhatItWasTold) {
  EXPECT_EQ(told_in(20ms), false);
  answers = false;
  enter(State::HardwareInit);
  EXPECT_EQ(told_in(50ms), true);
  EXPECT_EQ(said(), power_changes);
  answers = true;
  EXPECT_EQ(told_in(20ms), true);
  EXPECT_EQ(said(), power_on);
}

TEST_F(PowerTest, WhoAnswersByFramesOfAnotherVersionIsNotTakenForAnything) {
  enter(State::HardwareInit);
  EXPECT_EQ(told_in(20ms), true);
  EXPECT_EQ(said(), power_on);
  std::array<std::byte, power_frame_octets> frame{};
  ASSERT_TRUE(write_power_status(frame, {true, sequences.back()}));
  static_cast<void>(power->send(hirosco::testing::sealed_as(0x5A, frame)));
  run(Guard::period);
  EXPECT_EQ(said(), power_unknown_version);
  EXPECT_EQ(told_in(20ms), true);
  EXPECT_EQ(said(), power_on) << "one that it knows came";
}

TEST_F(PowerTest, AnAnswerToAnEarlierCommandIsNoWordAboutTheNewOne) {
  EXPECT_EQ(told_in(20ms), false);
  enter(State::HardwareInit);
  EXPECT_EQ(told_in(20ms), true);
  enter(State::Offline);
  EXPECT_EQ(told_in(20ms), false);
  answers = false;
  enter(State::HardwareInit);
  EXPECT_EQ(told_in(10ms), true);
  std::array<std::byte, power_frame_octets> frame;
  static_cast<void>(power->send(*write_power_status(frame, {true, sequences.front() + 4})));
  EXPECT_EQ(told_in(10ms), true);
  EXPECT_EQ(said(), power_changes);
}

TEST_F(PowerTest, ALateAnswerIsNoWordAboutTheNewCommandInWhateverDirectionItGoes) {
  for (const bool on : {true, false}) {
    answers = true;
    enter(on ? State::Offline : State::HardwareInit);
    EXPECT_EQ(told_in(20ms), !on);
    const std::uint32_t before = sequences.back();
    answers = false;
    enter(on ? State::HardwareInit : State::Offline);
    EXPECT_EQ(told_in(20ms), on);
    const auto answered = [&](std::uint32_t sequence) {
      std::array<std::byte, power_frame_octets> frame;
      static_cast<void>(power->send(*write_power_status(frame, {on, sequence})));
      static_cast<void>(told_in(Guard::period));
      return said();
    };
    EXPECT_EQ(answered(before - 1), power_changes) << on;
    EXPECT_EQ(answered(before), power_changes) << on << ": the last command before it";
    EXPECT_EQ(answered(before + 1), on ? power_on : power_off) << on;
  }
}

TEST_F(PowerTest, EachCommandHasASequenceOfItsOwnAsARepetitionIsNoSignOfLife) {
  EXPECT_EQ(told_in(50ms), false);
  for (std::size_t i = 1; i < sequences.size(); ++i) EXPECT_EQ(sequences[i], sequences[i - 1] + 1);
}

TEST_F(PowerTest, WhatADeadMemberLeavesMovingHasPowerForItsStopAndNoLonger) {
  enter(State::Operational);
  EXPECT_EQ(told_in(20ms, DeviceOutput::Active), true);
  guard.forget(arm);
  // 200 ms of its declared stop and 250 ms for its answer, which does not come.
  EXPECT_EQ(told_in(440ms, DeviceOutput::Stopping), true);
  EXPECT_EQ(told_in(20ms, DeviceOutput::Stopping), std::nullopt) << "it goes off in between";
  EXPECT_EQ(told_in(1s, DeviceOutput::Stopping), false);
}

TEST_F(PowerTest, WhatADeadMemberLeavesAtRestHasNoPowerWithTheWordOfItsDevice) {
  enter(State::Operational);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  EXPECT_EQ(told_in(20ms, DeviceOutput::Active), true);
  guard.forget(arm);
  EXPECT_EQ(told_in(50ms, DeviceOutput::Stopping), true);
  static_cast<void>(told_in(10ms, DeviceOutput::Holding));
  EXPECT_EQ(told_in(20ms, DeviceOutput::Holding), false);
}

TEST_F(PowerTest, AMemberThatWasNeverUpGetsNoPowerByItsEnd) {
  guard.forget(arm);
  EXPECT_EQ(told_in(100ms, std::nullopt), false);
}

TEST_F(PowerTest, ANewProcessAfterADeathBeginsWithoutPowerUntilItAsks) {
  enter(State::Operational);
  EXPECT_EQ(told_in(20ms), true);
  guard.forget(arm);
  static_cast<void>(told_in(500ms));
  start(arm);
  EXPECT_EQ(told_in(20ms), false);
  EXPECT_EQ(said(), power_off);
  enter(State::HardwareInit);
  EXPECT_EQ(told_in(20ms), true);
  EXPECT_EQ(said(), power_on);
}

TEST_F(PowerTest, WhatHasNoPowerHasStoppedThoughItCannotSaySo) {
  EXPECT_EQ(told_in(20ms, std::nullopt), false);
  const auto stop = guard.stop_all();
  static_cast<void>(told_in(20ms, std::nullopt));
  const auto outcome = guard.stop_outcome(stop);
  ASSERT_TRUE(outcome);
  const auto answer = std::ranges::find(*outcome, arm, &StopAnswer::apid);
  ASSERT_NE(answer, outcome->end());
  EXPECT_TRUE(answer->asked_device);
  EXPECT_TRUE(answer->stopped);
}

TEST_F(PowerTest, OfAMemberThatHasAProcessNoEndBeforeKeepsItsSwitchFromBeingTold) {
  EXPECT_EQ(told_in(20ms, std::nullopt), false);
  guard.ended_before(arm);
  EXPECT_EQ(told_in(20ms, std::nullopt), false);
}

TEST_F(PowerTest, ASwitchThatHasHungUpHasNotSaidThatItIsOff) {
  enter(State::HardwareInit);
  EXPECT_EQ(told_in(20ms), true);
  EXPECT_EQ(said(), power_on);
  power.reset();
  enter(State::Offline);
  run(1s);
  EXPECT_EQ(said(), power_changes);
}

TEST_F(PowerTest, WhatIsNoFrameIsNoWordOfASwitchAndNoneOfAnotherVersion) {
  enter(State::HardwareInit);
  EXPECT_EQ(told_in(20ms), true);
  ASSERT_EQ(said(), power_on);
  ASSERT_TRUE(power->send(std::array<std::byte, power_frame_octets>{}));
  run(Guard::period);
  EXPECT_EQ(said(), power_on);
}

TEST_F(PowerTest, APageThatSaysNothingTakesNoPowerFromABrakeButTheEndOfItsMemberDoes) {
  cycling(arm);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  EXPECT_EQ(told_in(20ms, DeviceOutput::Active), true);
  lives[arm].vital->state = 99;
  EXPECT_EQ(told_in(Guard::grace - 50ms, DeviceOutput::Holding), true);
  EXPECT_FALSE(lives[arm].process->killed);
  static_cast<void>(told_in(100ms, DeviceOutput::Holding));
  ASSERT_TRUE(lives[arm].process->killed);
  EXPECT_EQ(told_in(20ms, DeviceOutput::Holding), false);
}

/// As the descriptor of ARM's motor declares it.
struct SwitchedMotorThatHolds : PowerTest {
  SwitchedMotorThatHolds() { mission.subsystems[0].subsystem.devices[0].stop = descriptor::StopKind::Hold; }
};

TEST_F(SwitchedMotorThatHolds, MayBeOffInAStopWhereItHasHadNoPowerSinceItActed) {
  enter(State::Operational);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  static_cast<void>(told_in(50ms, DeviceOutput::Active));
  enter(State::Offline);
  static_cast<void>(told_in(1s, DeviceOutput::Holding));
  ASSERT_EQ(said(), power_off);
  enter(State::HardwareInit);
  static_cast<void>(told_in(50ms, DeviceOutput::Off));
  const auto stop = guard.stop_all();
  static_cast<void>(told_in(50ms, DeviceOutput::Off));
  const auto answers_to_it = guard.stop_outcome(stop);
  ASSERT_TRUE(answers_to_it);
  EXPECT_TRUE(answers_to_it->at(0).stopped);
  EXPECT_EQ(answers_to_it->at(0).otherwise, "");
}

TEST_F(PowerTest, WhatALivingMemberLeavesMovingHasPowerUntilItRests) {
  enter(State::Operational);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  EXPECT_EQ(told_in(20ms, DeviceOutput::Active), true);
  guard.fence(arm);
  enter(State::SafeOperational);
  EXPECT_EQ(told_in(10ms, DeviceOutput::Stopping), true);
  for (const State down : {State::HardwareDeinit, State::SoftwareDeinit, State::Offline}) {
    enter(down);
    EXPECT_EQ(told_in(50ms, DeviceOutput::Stopping), true) << to_text(down);
    EXPECT_EQ(said(), power_on) << "Offline waits for it";
  }
  static_cast<void>(told_in(10ms, DeviceOutput::Holding));
  EXPECT_EQ(told_in(20ms, DeviceOutput::Holding), false);
  EXPECT_EQ(said(), power_off);
}

TEST_F(PowerTest, WhatALivingMemberLeavesMovingHasPowerNoLongerThanItsStopMayTake) {
  for (int time = 0; time < 2; ++time) {
    enter(State::Operational);
    ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
    EXPECT_EQ(told_in(20ms, DeviceOutput::Active), true);
    enter(State::SoftwareDeinit);
    EXPECT_EQ(told_in(440ms, DeviceOutput::Stopping), true);
    EXPECT_EQ(told_in(20ms, DeviceOutput::Stopping), std::nullopt) << "it goes off in between";
    EXPECT_EQ(told_in(500ms, DeviceOutput::Stopping), false) << "and is not switched on again";
  }
}

/// Beside its motor, which can be asked, a gripper that cannot.
struct HalfAsked : PowerTest {
  HalfAsked() {
    descriptor::Device gripper;
    gripper.name = "GRIPPER";
    gripper.actuator = true;
    gripper.stop_within = 600ms;
    mission.subsystems[0].subsystem.devices.push_back(gripper);
  }
};

TEST_F(HalfAsked, WhatCannotBeAskedHasPowerForTheStopThatItDeclaresWhateverItsNeighbourSays) {
  for (const bool dies : {false, true}) {
    enter(State::Operational);
    EXPECT_EQ(told_in(20ms, DeviceOutput::Holding), true);
    if (dies) guard.forget(arm);
    else enter(State::SoftwareDeinit);
    EXPECT_EQ(told_in(840ms, DeviceOutput::Holding), true) << dies;
    EXPECT_EQ(told_in(20ms, DeviceOutput::Holding), std::nullopt) << dies;
    EXPECT_EQ(told_in(100ms, DeviceOutput::Holding), false) << dies;
  }
}

/// A guard that goes on for one that died, with a member that died as well: nothing tells it whether its motor has power.
struct DiedBefore : PowerTest {
  void SetUp() override {
    PowerTest::SetUp();
    auto described = mission.subsystems[0];
    described.subsystem.devices[0].enable->address = "next-enable";
    described.subsystem.power_switches[0].endnode.address = "next-power";
    motor = flows.open({Transfer::SharedMemory, "next-enable"}, FlowSide::Device).value();
    power = flows.open({Transfer::SharedMemory, "next-power"}, FlowSide::Device).value();
    held = std::make_unique<descriptor::MissionSubsystem>(std::move(described));
    ASSERT_TRUE(next.add(*held, false));
    next.ended_before(arm);
  }
  /// Its guard's steps, answered by the motor; how often the switch was told anything.
  int told_by_next(Duration span, DeviceOutput output) {
    int times = 0;
    for (const TimePoint end = clock.now() + span; clock.now() < end; clock.advance(Guard::period)) {
      static_cast<void>(next.step(clock.now()));
      if (const auto command = hear()) {
        ++times;
        EXPECT_FALSE(command->on);
      }
      std::array<std::byte, enable_frame_octets> frame;
      const auto received = motor->receive(frame);
      if (!received || received->flow != Flow::New) continue;
      const auto command = read_enable_command(frame).value();
      EXPECT_EQ(command.enabled, 0);
      static_cast<void>(motor->send(
          *write_enable_status(frame, {.output = output, .flags = 0, .epoch = 0, .sequence = command.sequence})));
    }
    return times;
  }
  std::unique_ptr<descriptor::MissionSubsystem> held;
  Guard next{{.clock = clock, .flows = flows, .first_epoch = 5000, .on_finding = {}}};
};

TEST_F(DiedBefore, ItsSwitchIsToldNothingWhileItMayComeToRestAndIsTurnedOffThen) {
  EXPECT_EQ(told_by_next(445ms, DeviceOutput::Stopping), 0);
  EXPECT_GE(told_by_next(50ms, DeviceOutput::Stopping), 8);
}

TEST_F(DiedBefore, ItsSwitchIsTurnedOffWithTheWordOfItsDeviceThatItRests) {
  EXPECT_EQ(told_by_next(100ms, DeviceOutput::Stopping), 0);
  EXPECT_GE(told_by_next(50ms, DeviceOutput::Holding), 8);
}

TEST_F(DiedBefore, WhereTheMemberLivesOnItsSwitchIsTurnedOffAtOnceIfItWasSaidToBeOff) {
  enter(State::Offline);
  for (const auto& [powered, told] : {std::pair{power_off, true}, {power_on, false}, {power_changes, false}}) {
    AdoptedSubsystem adopted;
    adopted.powered = powered;
    adopted.launched.vital = lives[arm].vital_memory;
    adopted.launched.permit = lives[arm].permit_memory;
    static_cast<void>(next.adopt(arm, adopted, {}));
    EXPECT_EQ(told_by_next(100ms, DeviceOutput::Stopping) > 0, told) << powered;
  }
}

TEST_F(DiedBefore, WhereTheMemberLivesOnInAStateThatNeedsPowerItsSwitchIsToldSoAtOnce) {
  enter(State::Operational);
  AdoptedSubsystem adopted;
  adopted.powered = power_on;
  adopted.launched.vital = lives[arm].vital_memory;
  adopted.launched.permit = lives[arm].permit_memory;
  static_cast<void>(next.adopt(arm, adopted, {}));
  for (int steps = 0; steps < 4; ++steps, clock.advance(Guard::period)) {
    static_cast<void>(next.step(clock.now()));
    const auto command = hear();
    ASSERT_TRUE(command) << "a switch that hears nothing goes off by itself";
    EXPECT_TRUE(command->on);
  }
}

/// Two switches for the devices of one member.
struct TwoSwitches : PowerTest {
  TwoSwitches() {
    descriptor::Endnode endnode;
    endnode.address = "brake-power";
    mission.subsystems[0].subsystem.power_switches.push_back({"BRAKE", endnode, {}});
  }
};

TEST_F(TwoSwitches, AreOnOrOffOnlyWhereEachHasSaidSo) {
  const auto brake = flows.open({Transfer::SharedMemory, "brake-power"}, FlowSide::Device).value();
  EXPECT_EQ(told_in(20ms), false);
  EXPECT_EQ(said(), power_changes) << "one of them has said nothing yet";
  std::array<std::byte, power_frame_octets> frame;
  const auto brake_answers = [&] {
    ASSERT_EQ(brake->receive(frame).value().flow, Flow::New);
    const PowerCommand command = read_power_command(frame).value();
    static_cast<void>(brake->send(*write_power_status(frame, {command.on, command.sequence})));
    static_cast<void>(told_in(Guard::period));
  };
  brake_answers();
  EXPECT_EQ(said(), power_off);
  enter(State::HardwareInit);
  EXPECT_EQ(told_in(20ms), true);
  EXPECT_EQ(said(), power_changes) << "one of them is off still";
  brake_answers();
  EXPECT_EQ(said(), power_on);
}

TEST_F(DiedBefore, ItIsAskedInAStop) {
  told_by_next(20ms, DeviceOutput::Stopping);
  const auto stop = next.stop_all();
  told_by_next(100ms, DeviceOutput::Stopping);
  EXPECT_FALSE(next.stop_outcome(stop)) << "it comes to rest still";
  told_by_next(20ms, DeviceOutput::Holding);
  ASSERT_TRUE(next.stop_outcome(stop));
  ASSERT_EQ(next.stop_outcome(stop)->size(), 1u);
  EXPECT_TRUE(next.stop_outcome(stop)->front().stopped);
}

TEST_F(PowerTest, WhereNothingMovesThePowerGoesAtOnce) {
  mission.subsystems[0].subsystem.devices.clear();
  Guard second{{.clock = clock, .flows = flows, .on_finding = {}}};
  auto sensor = mission.subsystems[0];
  sensor.subsystem.power_switches[0].endnode.address = "sensor-power";
  power = flows.open({Transfer::SharedMemory, "sensor-power"}, FlowSide::Device).value();
  ASSERT_TRUE(second.add(sensor, false));
  LaunchedSubsystem launched;
  launched.vital = lives[arm].vital_memory;
  launched.permit = lives[arm].permit_memory;
  second.started(arm, launched);
  enter(State::Operational);
  static_cast<void>(second.step(clock.now()));
  EXPECT_TRUE(hear()->on);
  enter(State::SoftwareDeinit);
  static_cast<void>(second.step(clock.now()));
  EXPECT_FALSE(hear()->on);
}

TEST_F(PowerTest, ThePageOfAMemberWithoutSwitchesSaysOff) {
  cycling(hand, State::Operational);
  EXPECT_EQ(told_in(20ms), false);
  EXPECT_EQ(lives[hand].permit->powered.load(), power_off);
}

}  // namespace
}  // namespace hirosco::supervisor
