// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/inhibit_watch.hpp"

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "supervisor/guard/testing/guard_rig.hpp"

/// A second inhibit with three ways, whose answers have an age limit (docs/adr/0237): by which it is enabled, by which inhibited, and what a lost one means.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Found = GuardFinding::Kind;

/// ARM's motor is asked by three ways; the test plays the ends of all, and each may be cut.
struct InhibitWatchTest : GuardTest {
  static constexpr std::size_t ways = 3;
  static constexpr Duration limit = 30ms;
  static constexpr std::array addresses{"motor-enable", "motor-enable-b", "motor-enable-c"};
  explicit InhibitWatchTest(bool goes_on = false) {
    descriptor::Device& device = mission.subsystems[0].subsystem.devices[0];
    for (std::size_t way = 1; way < ways; ++way) {
      device.enable_terms.fall_backs.push_back(*device.enable);
      device.enable_terms.fall_backs.back().address = addresses[way];
    }
    device.enable_terms.silence = limit;
    device.enable_terms.silence_reduced = 80ms;
    device.enable_terms.goes_on = goes_on;
  }
  void SetUp() override {
    GuardTest::SetUp();
    ends[0] = std::move(motor);
    for (std::size_t way = 1; way < ways; ++way)
      ends[way] = flows.open({Transfer::SharedMemory, addresses[way]}, FlowSide::Device).value();
    lives[arm].vital->configuration = 2;
    step();
  }
  /// One step of the guard; what each way was told in it, and answers by those that are not cut.
  void step(DeviceOutput output = DeviceOutput::Off) {
    guard.beat();
    for (auto& [apid, life] : lives) {
      ++life.vital->cycles;
      ++life.vital->service_steps;
      life.vital->seen_epoch = life.permit->epoch.load();
    }
    static_cast<void>(guard.step(clock.now()));
    for (std::size_t way = 0; way < ways; ++way) {
      told_by[way].reset();
      std::array<std::byte, enable_frame_octets> frame;
      const auto received = ends[way]->receive(frame);
      if (!received || received->flow != Flow::New) continue;
      told_by[way] = read_enable_command(frame).value();
      if (cut[way]) continue;
      static_cast<void>(ends[way]->send(
          *write_enable_status(frame, {.output = output, .flags = 0, .epoch = 0, .sequence = told_by[way]->sequence})));
    }
    clock.advance(Guard::period);
  }
  void steps(Duration span) {
    for (const TimePoint end = clock.now() + span; clock.now() < end;) step();
  }
  void let_move() {
    cycling(arm);
    ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
    step();
    EXPECT_THAT(guard.take_findings(), IsEmpty());
  }
  /// The ways by which it was told to move in the last step.
  [[nodiscard]] std::vector<std::size_t> enabled_by() const {
    std::vector<std::size_t> found;
    for (std::size_t way = 0; way < ways; ++way)
      if (told_by[way] && told_by[way]->enabled == 1) found.push_back(way);
    return found;
  }
  void expect_inhibited_by_all() const {
    for (std::size_t way = 0; way < ways; ++way) {
      ASSERT_TRUE(told_by[way]) << way;
      EXPECT_EQ(told_by[way]->enabled, 0) << way;
      EXPECT_EQ(told_by[way]->epoch, told_by[0]->epoch) << way;
    }
  }

  std::array<std::unique_ptr<DataFlow>, ways> ends;
  std::array<std::optional<EnableCommand>, ways> told_by;
  std::array<bool, ways> cut{};
};
struct InhibitGoesOn : InhibitWatchTest {
  InhibitGoesOn() : InhibitWatchTest{true} {}
};

TEST_F(InhibitWatchTest, EnablesByThePreferredWayAloneAndTheOthersAreToldNothingMeanwhile) {
  let_move();
  for (int i = 0; i < 100; ++i) {
    step();
    ASSERT_THAT(enabled_by(), ElementsAre(0U));
    ASSERT_FALSE(told_by[1] || told_by[2]);
  }
  EXPECT_THAT(guard.take_findings(), IsEmpty());
}

/// In each state, whoever stops it, and whatever of its ways still carries an answer.
TEST_F(InhibitWatchTest, AStopGoesOutByEachWayInEveryStateWhoeverAsksForIt) {
  const auto fence = [&] { static_cast<void>(guard.fence(arm)); };
  const auto stop_all = [&] { static_cast<void>(guard.stop_all()); };
  const auto forget = [&] { guard.forget(arm); };
  for (unsigned cuts = 0; cuts < 1U << ways; ++cuts)
    for (std::uint32_t state = 0; state <= static_cast<std::uint32_t>(State::SoftwareDeinit); ++state)
      for (const auto& stop : std::vector<std::function<void()>>{fence, stop_all, forget}) {
        SCOPED_TRACE(::testing::Message() << "state " << state << " cuts " << cuts);
        start(arm);
        lives[arm].vital->configuration = 2;
        cut = {};
        steps(limit);
        static_cast<void>(guard.take_findings());
        for (int tries = 0; !guard.release(arm, guard.fences(arm)) && tries < 200; ++tries) step();
        step();
        ASSERT_THAT(enabled_by(), ElementsAre(0U));
        cycling(arm, static_cast<State>(state));
        for (std::size_t way = 0; way < ways; ++way) cut[way] = (cuts >> way & 1U) != 0;
        stop();
        for (int i = 0; i < 3; ++i) {
          step();
          expect_inhibited_by_all();
        }
      }
}

TEST_F(InhibitWatchTest, AnAnswerThatIsTooOldIsNoneAndItIsInhibitedByEachWayAndFenced) {
  let_move();
  cut[0] = true;
  const TimePoint heard = clock.now();
  while (!enabled_by().empty() && clock.now() - heard < 1s) step();
  EXPECT_GE(clock.now() - heard, limit - Guard::period);
  EXPECT_LE(clock.now() - heard, limit + 2 * Guard::period);
  expect_inhibited_by_all();
  EXPECT_FALSE(may_move(arm));
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitLost));
  steps(1s);
  EXPECT_THAT(kinds(arm), IsEmpty()) << "once";
  expect_inhibited_by_all();
}

TEST_F(InhibitWatchTest, NobodyLetsItGoBeforeTheSupervisorHasHeardOfIt) {
  let_move();
  cut[0] = true;
  steps(100ms);
  EXPECT_FALSE(guard.release(arm, guard.fences(arm)));
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitLost));
  EXPECT_TRUE(guard.release(arm, guard.fences(arm)));
}

TEST_F(InhibitWatchTest, WhoIsLetGoAgainGoesByTheNextWayThatAnswersAndBackToTheFirstWhenThatDoes) {
  let_move();
  cut[0] = cut[1] = true;
  steps(100ms);
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitLost));
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  step();
  EXPECT_THAT(enabled_by(), ElementsAre(2U)) << "the second does not answer either";
  steps(1s);
  EXPECT_THAT(enabled_by(), ElementsAre(2U));
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitFellBack));
  static_cast<void>(guard.fence(arm));
  cut[0] = false;
  steps(20ms);
  let_move();
  EXPECT_THAT(enabled_by(), ElementsAre(0U));
}

TEST_F(InhibitWatchTest, WithoutAnyWayThatAnswersItIsFencedEachTime) {
  let_move();
  cut = {true, true, true};
  for (int times = 0; times < 3; ++times) {
    steps(limit + 4 * Guard::period);
    EXPECT_FALSE(may_move(arm));
    EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitLost)) << times;
    ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
    step();
    EXPECT_THAT(enabled_by(), ElementsAre(0U)) << times;
  }
}

TEST_F(InhibitWatchTest, ARepeatedAnswerIsNoSignOfLife) {
  let_move();
  cut[0] = true;
  std::array<std::byte, enable_frame_octets> frame;
  const std::uint32_t answered = told_by[0]->sequence;
  for (const TimePoint end = clock.now() + 60ms; clock.now() < end;) {
    static_cast<void>(ends[0]->send(
        *write_enable_status(frame, {.output = DeviceOutput::Off, .flags = 0, .epoch = 0, .sequence = answered})));
    step();
  }
  EXPECT_FALSE(may_move(arm));
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitLost));
}

TEST_F(InhibitWatchTest, WithoutRealTimeSchedulingTheOtherLimitHolds) {
  lives[arm].vital->realtime = 0;
  let_move();
  cut[0] = true;
  steps(70ms);
  EXPECT_TRUE(may_move(arm));
  steps(20ms);
  EXPECT_FALSE(may_move(arm));
}

TEST_F(InhibitWatchTest, OfADeviceThatItsConfigurationDoesNotUseNoAnswerIsMissed) {
  lives[arm].vital->configuration = 0;
  let_move();
  cut = {true, true, true};
  steps(1s);
  EXPECT_TRUE(may_move(arm));
  EXPECT_THAT(kinds(arm), IsEmpty());
}

TEST_F(InhibitWatchTest, AStopIsAnsweredByWhicheverWayCarriesAnAnswer) {
  for (std::size_t alone = 0; alone < ways; ++alone) {
    cut = {};
    steps(20ms);
    static_cast<void>(guard.take_findings());
    for (int tries = 0; !guard.release(arm, guard.fences(arm)) && tries < 200; ++tries) step();
    cycling(arm);
    step();
    cut = {true, true, true};
    cut[alone] = false;
    const auto stop = guard.stop_all();
    lives[arm].vital->inhibited = inhibited_by_stop;
    steps(100ms);
    const auto outcome = guard.stop_outcome(stop);
    ASSERT_TRUE(outcome) << alone;
    for (const StopAnswer& answer : *outcome) EXPECT_TRUE(!answer.asked_device || answer.stopped) << alone;
    lives[arm].vital->inhibited = 0;
  }
}

TEST_F(InhibitWatchTest, WhatALeftWaySaysLateIsNoNewsOfTheDevice) {
  std::array<std::byte, enable_frame_octets> frame;
  steps(50ms);
  const std::uint32_t old = told_by[1]->sequence - 5;
  let_move();
  step(DeviceOutput::Active);
  static_cast<void>(guard.fence(arm));
  cut = {true, true, true};
  step();
  const auto stop = guard.stop_all();
  static_cast<void>(ends[1]->send(
      *write_enable_status(frame, {.output = DeviceOutput::Off, .flags = 0, .epoch = 0, .sequence = old})));
  steps(100ms);
  EXPECT_FALSE(guard.stop_outcome(stop)) << "that it was off before it moved";
}

TEST_F(InhibitGoesOn, ByTheNextWayWithoutAStopAndBeforeTheDeviceLetsGo) {
  let_move();
  cut[0] = true;
  const TimePoint heard = clock.now();
  while (enabled_by() != std::vector<std::size_t>{1} && clock.now() - heard < 1s) step();
  EXPECT_LT(clock.now() - heard, enable_limit - Guard::period);
  EXPECT_TRUE(may_move(arm));
  steps(1s);
  EXPECT_THAT(enabled_by(), ElementsAre(1U));
  EXPECT_FALSE(told_by[0]) << "nothing more goes out by what was left";
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitFellBack));
}

TEST_F(InhibitGoesOn, EachWayOnceAndTheLastOnesSilenceStopsIt) {
  let_move();
  cut = {true, true, true};
  steps(1s);
  EXPECT_FALSE(may_move(arm));
  expect_inhibited_by_all();
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitFellBack, Found::InhibitFellBack, Found::InhibitLost));
}

TEST_F(InhibitGoesOn, WhatWasStoppedIsEnabledByNoFallBack) {
  let_move();
  static_cast<void>(guard.fence(arm));
  cut[0] = true;
  for (int i = 0; i < 200; ++i) {
    step();
    expect_inhibited_by_all();
  }
  EXPECT_THAT(kinds(arm), IsEmpty());
}

/// Two drives of one member: the first is told in the same step in which the second is lost.
TEST_F(InhibitWatchTest, WhoIsFencedForOneDeviceHasNoOtherOneEnabledInTheSameStep) {
  auto described = mission.subsystems[1];
  for (const char* name : {"LEFT", "RIGHT"}) {
    described.subsystem.devices.push_back(mission.subsystems[0].subsystem.devices[0]);
    described.subsystem.devices.back().name = described.subsystem.devices.back().enable->address = name;
    described.subsystem.devices.back().enable_terms.fall_backs.clear();
  }
  descriptor::Configuration uses_both = mission.subsystems[0].subsystem.configurations.front();
  uses_both.devices.assign(2, descriptor::DeviceUse{});
  uses_both.devices[1].device = 1;
  described.subsystem.configurations = {uses_both};
  Guard second{{.clock = clock, .flows = flows, .on_finding = {}}};
  ASSERT_TRUE(second.add(described, false));
  LaunchedSubsystem launched;
  launched.vital = lives[hand].vital_memory;
  launched.permit = lives[hand].permit_memory;
  launched.grip = lives[hand].process;
  second.started(hand, launched);
  lives[hand].vital->configuration = described.subsystem.configurations.front().id;
  cycling(hand);
  std::array<std::unique_ptr<DataFlow>, 2> both{
      flows.open({Transfer::SharedMemory, "LEFT"}, FlowSide::Device).value(),
      flows.open({Transfer::SharedMemory, "RIGHT"}, FlowSide::Device).value()};
  ASSERT_TRUE(second.release(hand, second.fences(hand)));
  bool right_answers = true;
  std::array<int, 2> enabled{};
  const auto one = [&] {
    ++lives[hand].vital->cycles;
    ++lives[hand].vital->service_steps;
    lives[hand].vital->seen_epoch = lives[hand].permit->epoch.load();
    static_cast<void>(second.step(clock.now()));
    for (std::size_t i = 0; i < 2; ++i) {
      std::array<std::byte, enable_frame_octets> frame;
      ASSERT_EQ(both[i]->receive(frame).value().flow, Flow::New);
      const auto command = read_enable_command(frame).value();
      enabled[i] = command.enabled;
      if (i == 0 || right_answers)
        static_cast<void>(both[i]->send(*write_enable_status(
            frame, {.output = DeviceOutput::Active, .flags = 0, .epoch = 0, .sequence = command.sequence})));
    }
    clock.advance(Guard::period);
  };
  one();
  EXPECT_THAT(enabled, ElementsAre(1, 1));
  right_answers = false;
  for (int i = 0; i < 20 && enabled[1] == 1; ++i) one();
  EXPECT_THAT(enabled, ElementsAre(0, 0));
}

}  // namespace
}  // namespace hirosco::supervisor
