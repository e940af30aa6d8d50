// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <optional>
#include <tuple>

#include "hirosco/data_transfer/device/power_frame.hpp"
#include "supervisor/guard/testing/guard_rig.hpp"

/// A power switch with two ways, judged at both: the test plays it.
namespace hirosco::supervisor {
namespace {

using namespace testing;

/// The switch is told by two ways, and its words have an age limit (docs/adr/0237).
struct TwoWaysOfPower : GuardTest {
  static constexpr Duration limit = 50ms;
  TwoWaysOfPower() {
    descriptor::Endnode endnode;
    endnode.address = "motor-power";
    descriptor::PowerSwitch switched{"MOTOR", endnode, {}};
    switched.terms.fall_backs = {endnode};
    switched.terms.fall_backs[0].address = "motor-power-b";
    switched.terms.silence = switched.terms.silence_reduced = limit;
    mission.subsystems[0].subsystem.power_switches = {switched};
  }
  void SetUp() override {
    GuardTest::SetUp();
    power = flows.open({Transfer::SharedMemory, "motor-power"}, FlowSide::Device).value();
    other = flows.open({Transfer::SharedMemory, "motor-power-b"}, FlowSide::Device).value();
  }
  /// Steps; what each way was told in the last one.
  void steps(Duration span, bool first_answers, bool second_answers) {
    for (const TimePoint end = clock.now() + span; clock.now() < end;) {
      run(Guard::period);
      for (const auto& [end_of_it, heard, says] :
           {std::tuple{&power, &by_first, first_answers}, {&other, &by_second, second_answers}}) {
        std::array<std::byte, power_frame_octets> frame;
        const auto received = (*end_of_it)->receive(frame);
        if (!received || received->flow != Flow::New) {
          heard->reset();
          continue;
        }
        const auto command = read_power_command(frame).value();
        *heard = command;
        if (says) static_cast<void>((*end_of_it)->send(*write_power_status(frame, {command.on, command.sequence})));
      }
    }
  }
  void enter(State state) { lives[arm].vital->state = static_cast<std::uint32_t>(state); }
  [[nodiscard]] std::uint32_t said() { return lives[arm].permit->powered.load(); }

  std::unique_ptr<DataFlow> power, other;
  std::optional<PowerCommand> by_first, by_second;
};

TEST_F(TwoWaysOfPower, EachIsToldTheSameInEveryState) {
  for (std::uint32_t state = 0; state <= static_cast<std::uint32_t>(State::SoftwareDeinit); ++state) {
    enter(static_cast<State>(state));
    steps(50ms, true, true);
    ASSERT_TRUE(by_first && by_second) << state;
    EXPECT_EQ(by_first->on, by_second->on) << state;
    EXPECT_EQ(by_first->sequence, by_second->sequence) << state;
    EXPECT_EQ(said(), by_first->on ? power_on : power_off) << state;
  }
}

TEST_F(TwoWaysOfPower, OfflineSwitchesOffByTheOneThatIsLeftAndIsToldSo) {
  for (const bool first : {true, false}) {
    enter(State::Operational);
    steps(50ms, true, true);
    EXPECT_EQ(said(), power_on);
    enter(State::Offline);
    steps(20ms, first, !first);
    EXPECT_FALSE(by_first->on || by_second->on);
    EXPECT_EQ(said(), power_off) << first;
  }
}

TEST_F(TwoWaysOfPower, TheSilenceOfOneIsToldOnceAndTheOthersWordHolds) {
  enter(State::Operational);
  steps(200ms, true, true);
  EXPECT_THAT(kinds(arm), ::testing::IsEmpty());
  steps(1s, false, true);
  EXPECT_THAT(kinds(arm), ::testing::ElementsAre(GuardFinding::Kind::PowerFellBack));
  EXPECT_EQ(said(), power_on);
}

TEST_F(TwoWaysOfPower, WithoutAWordThatIsYoungEnoughPowerIsUnknownUntilThereIsOne) {
  for (const State state : {State::Operational, State::Offline}) {
    enter(state);
    steps(100ms, true, true);
    const Power before = state == State::Offline ? power_off : power_on;
    ASSERT_EQ(said(), before);
    static_cast<void>(guard.take_findings());
    steps(limit - 2 * Guard::period, false, false);
    EXPECT_EQ(said(), before);
    steps(4 * Guard::period, false, false);
    EXPECT_EQ(said(), power_changes) << "neither on nor off";
    steps(20ms, false, true);
    EXPECT_EQ(said(), before);
  }
}

TEST_F(TwoWaysOfPower, ThatItIsUnknownIsToldOnceWhereThereIsToBePower) {
  enter(State::Operational);
  steps(100ms, true, true);
  steps(1s, false, false);
  EXPECT_THAT(kinds(arm), ::testing::ElementsAre(GuardFinding::Kind::PowerSilent));
  steps(100ms, true, true);
  enter(State::Offline);
  steps(1s, false, false);
  EXPECT_THAT(kinds(arm), ::testing::IsEmpty());
}

/// Without power nothing moves; whether it has some nobody knows any more.
TEST_F(TwoWaysOfPower, AnOldWordThatItIsOffIsNoAnswerToAStop) {
  enter(State::Offline);
  steps(50ms, true, true);
  ASSERT_EQ(said(), power_off);
  for (const TimePoint end = clock.now() + 100ms; clock.now() < end;)
    run(Guard::period, {arm, hand, camera}, std::nullopt);
  ASSERT_EQ(said(), power_changes);
  const auto stop = guard.stop_all();
  for (const TimePoint end = clock.now() + 100ms; clock.now() < end;)
    run(Guard::period, {arm, hand, camera}, std::nullopt);
  EXPECT_FALSE(guard.stop_outcome(stop));
}

}  // namespace
}  // namespace hirosco::supervisor
