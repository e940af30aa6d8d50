// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/power_frame.hpp"
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

TEST_F(PowerTest, ThePageOfAMemberWithoutSwitchesSaysOff) {
  cycling(hand, State::Operational);
  EXPECT_EQ(told_in(20ms), false);
  EXPECT_EQ(lives[hand].permit->powered.load(), power_off);
}

}  // namespace
}  // namespace hirosco::supervisor
