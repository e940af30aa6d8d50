// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/testing/guard_rig.hpp"

/// What the guard does for members, pages, processes and devices that are not there, have not begun, or have ended.
namespace hirosco::supervisor {
namespace {

using testing::arm;
using testing::camera;
using ::testing::ElementsAre;
using testing::GuardTest;
using testing::hand;
using ::testing::IsEmpty;

constexpr auto cycle_hangs = GuardFinding::Kind::CycleHangs;
constexpr auto service_hangs = GuardFinding::Kind::ServiceHangs;
constexpr auto back = GuardFinding::Kind::Back;

/// The guard's steps alone: nobody cycles, serves or answers.
void steps_only(GuardTest& test, Duration span) {
  for (const TimePoint end = test.clock.now() + span; test.clock.now() < end; test.clock.advance(Guard::period)) {
    test.guard.beat();
    EXPECT_EQ(test.guard.step(test.clock.now()), test.clock.now() + Guard::period);
  }
}

TEST_F(GuardTest, WhoIsNobodyOfTheMissionIsNeitherFencedNorReleasedNorTakenOver) {
  constexpr std::uint16_t nobody = 99;
  guard.started(nobody, {});
  guard.fence(nobody);
  guard.forget(nobody);
  EXPECT_EQ(guard.fences(nobody), 0u);
  EXPECT_FALSE(guard.fenced(nobody));
  EXPECT_FALSE(guard.release(nobody, 0));
  guard.stop_all();
  EXPECT_FALSE(guard.was_stopped_since(nobody, 0));
  run(20ms);
  const auto before = guard.fences(arm);
  guard.falls_with(nobody, {arm});
  guard.ended_before(nobody);
  guard.life_changed(nobody);
  EXPECT_EQ(guard.fences(arm), before) << "nobody's end stops somebody";
}

TEST_F(GuardTest, PagesThatAreTooSmallAreNotTakenOver) {
  for (const bool small_vital : {true, false}) {
    guard.forget(arm);
    LaunchedSubsystem launched;
    const auto page = [&](std::size_t octets) {
      return memory.map(memory.create("page", octets).value(), Access::ReadWrite).value();
    };
    launched.vital = page(sizeof(VitalPage));
    launched.permit = page(sizeof(PermitPage));
    Mapping& small = small_vital ? launched.vital : launched.permit;
    small.octets = small.octets.first((small_vital ? sizeof(VitalPage) : sizeof(PermitPage)) - 1);
    guard.started(arm, launched);
    EXPECT_FALSE(guard.release(arm, guard.fences(arm)));
  }
}

TEST_F(GuardTest, AProcessThatHasEndedIsFencedAndNeverReleasedWithoutANewOne) {
  cycling(arm);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(20ms);
  EXPECT_EQ(told.enabled, 1);
  EXPECT_FALSE(guard.fenced(arm));
  guard.forget(arm);
  run(20ms);
  EXPECT_EQ(told.enabled, 0) << "its device hears of it";
  EXPECT_FALSE(guard.fenced(arm)) << "it has no page";
  EXPECT_FALSE(guard.release(arm, guard.fences(arm)));
  const auto before = guard.fences(arm);
  guard.fence(arm);
  EXPECT_EQ(guard.fences(arm), before + 1) << "what was permitted before is void for the next process, too";
}

TEST_F(GuardTest, WhatASecondFenceFindsStoppedKeepsTheCycleOfTheFirst) {
  cycling(arm);
  run(50ms);
  guard.fence(arm);
  const auto cycles = lives[arm].permit->stopped_at_cycle.load();
  EXPECT_EQ(cycles, lives[arm].vital->cycles.load());
  run(50ms);
  guard.fence(arm);
  EXPECT_EQ(lives[arm].permit->stopped_at_cycle.load(), cycles);
}

TEST_F(GuardTest, WhoStandsFencedAndWhoseGateIsDamagedIsFencedAnew) {
  cycling(arm);
  run(50ms);
  guard.fence(arm);
  PermitPage& page = *lives[arm].permit;
  const std::uint32_t epoch = page.epoch.load();
  const auto cycles = page.stopped_at_cycle.load();
  guard.fence(arm);
  EXPECT_EQ(page.epoch.load(), epoch) << "whole, it stays as it is";
  page.go = permission_word(epoch);
  guard.fence(arm);
  EXPECT_EQ(page.go.load(), 0u);
  EXPECT_EQ(page.epoch.load(), epoch + 1);
  page.epoch = 7;
  guard.fence(arm);
  EXPECT_EQ(page.epoch.load(), epoch + 2) << "no device hears of an epoch that it has heard of";
  EXPECT_EQ(page.stopped_at_cycle.load(), cycles);
  EXPECT_FALSE(may_move(arm));
}

TEST_F(GuardTest, ADeviceThatCannotBeOpenedIsSaidSo) {
  Guard second{{.clock = clock, .flows = flows, .on_finding = {}}};
  EXPECT_FALSE(second.add(mission.subsystems[0], false)) << "the first guard has its endnode";
}

TEST_F(GuardTest, OfADeviceWithoutASecondInhibitItsMemberAnswers) {
  auto described = mission.subsystems[0];
  described.subsystem.devices[0].enable.reset();
  Guard second{{.clock = clock, .flows = flows, .on_finding = {}}};
  ASSERT_TRUE(second.add(described, false));
  const auto stop = second.stop_all();
  EXPECT_FALSE(second.stop_outcome(stop)) << "nobody has looked yet";
  static_cast<void>(second.step(clock.now()));
  const auto answers = second.stop_outcome(stop);
  ASSERT_TRUE(answers && answers->size() == 1);
  EXPECT_EQ(answers->front().name, "MOTOR");
  EXPECT_FALSE(answers->front().asked_device);
  EXPECT_TRUE(answers->front().stopped) << "there is no process that could move anything";
}

TEST_F(GuardTest, EachFindingWakesTheSupervisorAndOfThoseThatNobodyTakesTheFirstAreKept) {
  int woken = 0;
  Guard second{{.clock = clock, .flows = flows, .on_finding = [&] { ++woken; }}};
  for (int i = 0; i < 2'000; ++i) second.stop_all(GuardFinding::Kind::StopAsked);
  EXPECT_EQ(woken, 2'000);
  EXPECT_EQ(second.take_findings().size(), 1'024u);
  EXPECT_THAT(second.take_findings(), IsEmpty());
  static_cast<void>(second.step(clock.now()));
  EXPECT_EQ(woken, 2'001) << "and when the stop has ended";
}

TEST_F(GuardTest, WhoHangsIsNotReleased) {
  cycling(arm);
  run(50ms);
  run(250ms, {hand, camera});
  EXPECT_THAT(kinds(arm), ElementsAre(cycle_hangs));
  EXPECT_FALSE(guard.release(arm, guard.fences(arm)));
  run(50ms);
  EXPECT_THAT(kinds(arm), ElementsAre(back));
  EXPECT_TRUE(guard.release(arm, guard.fences(arm)));
}

TEST_F(GuardTest, ACycleThatIsToldToRestWhileItHangsIsBack) {
  cycling(arm);
  run(50ms);
  run(250ms, {hand, camera});
  lives[arm].vital->cycling = 0;
  run(20ms, {hand, camera});
  EXPECT_THAT(kinds(arm), ElementsAre(cycle_hangs, back));
  run(2s, {hand, camera});
  EXPECT_FALSE(lives[arm].process->killed);
}

TEST_F(GuardTest, TheTimeOfAHangBeginsAnewWithARestAndWithANewProcess) {
  const auto hangs_after = [&] {
    Duration span{};
    for (; kinds(arm).empty() && span < 1s; span += Guard::observation_period)
      run(Guard::observation_period, {hand, camera});
    return span;
  };
  cycling(arm);
  run(50ms);
  // The first look after it has moved sees that it moved.
  const Duration limit = hangs_after() - Guard::observation_period;
  EXPECT_LT(limit, 250ms);
  run(50ms);
  EXPECT_THAT(kinds(arm), ElementsAre(back));
  run(100ms, {hand, camera});
  lives[arm].vital->cycling = 0;
  run(20ms, {hand, camera});
  lives[arm].vital->cycling = 1;
  EXPECT_EQ(hangs_after(), limit);
  guard.forget(arm);
  start(arm);
  cycling(arm);
  lives[arm].vital->seen_epoch = lives[arm].permit->epoch.load();
  EXPECT_EQ(hangs_after(), limit);
}

TEST_F(GuardTest, WithoutRealtimeRightsTheSecondLimitHolds) {
  mission.subsystems[1].subsystem.hang = {20, 40};
  lives[hand].vital->realtime = 0;
  cycling(hand);
  run(50ms);
  run(380ms, {arm, camera});
  EXPECT_THAT(kinds(hand), IsEmpty());
  run(50ms, {arm, camera});
  EXPECT_THAT(kinds(hand), ElementsAre(cycle_hangs));
}

TEST_F(GuardTest, AServiceLoopThatHasNotBegunDoesNotHang) {
  guard.forget(hand);
  start(hand);
  for (Duration span{}; span < 4s; span += Guard::period) {
    for (const std::uint16_t apid : {arm, camera}) ++lives[apid].vital->service_steps;
    steps_only(*this, Guard::period);
  }
  EXPECT_THAT(kinds(hand), IsEmpty());
}

TEST_F(GuardTest, InATransientStateAServiceLoopMayTakeAsLongAsThatMayLastAndComesBack) {
  lives[hand].vital->state = static_cast<std::uint32_t>(State::HardwareInit);
  run(20ms);
  steps_only(*this, Guard::transient_service_limit - 100ms);
  EXPECT_THAT(kinds(hand), IsEmpty());
  steps_only(*this, 200ms);
  EXPECT_THAT(kinds(hand), ElementsAre(service_hangs));
  EXPECT_FALSE(lives[hand].process->realtime);
  run(20ms);
  EXPECT_THAT(kinds(hand), ElementsAre(back));
}

TEST_F(GuardTest, OneWithoutAProcessToEndIsFencedAndToldAllTheSame) {
  lives[hand].process.reset();
  guard.forget(hand);
  start(hand);
  LaunchedSubsystem launched;
  launched.vital = lives[hand].vital_memory;
  launched.permit = lives[hand].permit_memory;
  guard.started(hand, launched);
  cycling(hand);
  run(50ms);
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  cycling(arm);
  run(Guard::grace + 400ms, {camera});
  EXPECT_THAT(kinds(hand), ElementsAre(cycle_hangs, GuardFinding::Kind::Killed));
  EXPECT_FALSE(may_move(hand));
  const auto stop = guard.stop_all();
  run(2s, {arm, camera});
  EXPECT_TRUE(guard.stop_outcome(stop)) << "it holds up no stop";
}

TEST_F(GuardTest, ASparedMemberIsReleasedDuringAStop) {
  cycling(arm);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  static_cast<void>(guard.stop_all());
  EXPECT_TRUE(guard.release(camera, guard.fences(camera)));
  EXPECT_FALSE(guard.release(arm, guard.fences(arm)));
}

TEST_F(GuardTest, WhoStandsAlreadyWhenEverythingIsStoppedIsReleasedAtOnceAndCountsAsStopped) {
  cycling(arm);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  const auto stop = guard.stop_all();
  ASSERT_TRUE(guard.release(hand, guard.fences(hand))) << "it never cycled";
  run(50ms, {arm, hand, camera}, DeviceOutput::Off);
  const auto answers = guard.stop_outcome(stop);
  ASSERT_TRUE(answers && answers->size() == 2);
  EXPECT_EQ(answers->at(1).stopped, Duration{0});
}

/// HAND has no device: what it says of itself is all that there is.
TEST_F(GuardTest, AMemberWithoutADeviceHasStoppedWhenItRestsIsOfflineOrKnowsTheFenceAndIsInhibited) {
  struct Case {
    const char* says;
    bool cycles, knows, inhibited;
    State state;
    bool stopped;
  };
  for (const Case& c :
       {Case{"it moves", true, true, false, State::Operational, false},
        Case{"inhibited by something older than the fence", true, false, true, State::Operational, false},
        Case{"inhibited", true, true, true, State::Operational, true},
        Case{"not Operational", true, true, false, State::SafeOperational, true},
        Case{"not Operational, as of before the fence", true, false, false, State::SafeOperational, false},
        Case{"it rests", false, false, false, State::Operational, true},
        Case{"Offline", true, false, false, State::Offline, true}}) {
    guard.forget(hand);
    start(hand);
    VitalPage& vital = *lives[hand].vital;
    looks = false;
    const auto stop = guard.stop_all();
    vital.cycling = c.cycles ? 1 : 0;
    vital.state = static_cast<std::uint32_t>(c.state);
    vital.inhibited = c.inhibited ? std::uint32_t{inhibited_by_stop} : 0U;
    vital.seen_epoch = lives[hand].permit->epoch.load() - (c.knows ? 0 : 1);
    for (int i = 0; i < 3; ++i) run(Guard::period);
    const auto answers = guard.stop_outcome(stop);
    EXPECT_EQ(answers.has_value(), c.stopped) << c.says;
    vital.cycling = 0;  // whatever it was, the stop ends
    run(1s);
    ASSERT_TRUE(guard.stop_outcome(stop)) << c.says;
  }
}

TEST_F(GuardTest, WhatADeviceSaysInDamagedFramesOrAfterItHungUpIsNoAnswer) {
  cycling(arm);
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  const auto stop = guard.stop_all();
  lives[arm].vital->inhibited = inhibited_by_stop;
  run(20ms, {arm, hand, camera}, std::nullopt);
  std::array<std::byte, enable_frame_octets> frame;
  ASSERT_TRUE(write_enable_status(frame, {.output = DeviceOutput::Off, .flags = 0, .epoch = 0, .sequence = 1'000'000}));
  frame.back() ^= std::byte{1};
  static_cast<void>(motor->send(frame));
  run(20ms, {arm, hand, camera}, std::nullopt);
  EXPECT_FALSE(guard.stop_outcome(stop));
  motor.reset();
  steps_only(*this, 20ms);
  EXPECT_FALSE(guard.stop_outcome(stop));
  steps_only(*this, 1s);
  const auto answers = guard.stop_outcome(stop);
  ASSERT_TRUE(answers);
  EXPECT_EQ(answers->at(0).stopped, std::nullopt);
}

TEST_F(GuardTest, AReleaseWhileTheSupervisorStandsStillEnablesNoDevice) {
  run(20ms);
  for (Duration span{}; span < Guard::supervisor_limit + 20ms; span += Guard::period) {
    static_cast<void>(guard.step(clock.now()));
    clock.advance(Guard::period);
  }
  EXPECT_THAT(kinds(0), ElementsAre(GuardFinding::Kind::SupervisorStill));
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  const auto enabled = [&] {
    std::array<std::byte, enable_frame_octets> frame;
    static_cast<void>(guard.step(clock.now()));
    static_cast<void>(motor->receive(frame));
    clock.advance(Guard::period);
    return read_enable_command(frame).value().enabled != 0;
  };
  EXPECT_FALSE(enabled());
  guard.beat();
  EXPECT_TRUE(enabled()) << "it is back";
}

/// A release raises the epoch, so a cycle that stops right behind it stood still without having looked.
TEST_F(GuardTest, WhoStopsRightAfterItsReleaseIsNotBlamedForTheProcessorTimeOfItsPast) {
  cycling(arm);
  cycling(hand);
  lives[hand].process->had = 100s;
  run(50ms);
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  for (int i = 0; i < 23; ++i) {
    lives[arm].process->had += 10ms;
    run(10ms, {camera});
  }
  EXPECT_THAT(kinds(arm), ElementsAre(cycle_hangs));
  EXPECT_TRUE(lives[hand].process->realtime);
}

TEST_F(GuardTest, WhoIsEndedAlreadyOrIsGoneIsNotBlamedForAnother) {
  cycling(arm);
  cycling(hand);
  run(50ms);
  looks = false;
  guard.fence(hand);
  run(250ms);
  EXPECT_THAT(kinds(hand), ElementsAre(GuardFinding::Kind::PageDamaged));
  lives[hand].process->had += 100s;
  run(250ms, {hand, camera});
  EXPECT_THAT(kinds(arm), ElementsAre(cycle_hangs));
  EXPECT_THAT(kinds(hand), IsEmpty());
  looks = true;
  for (const std::uint16_t apid : {arm, hand}) {
    guard.forget(apid);
    start(apid);
    cycling(apid);
  }
  run(50ms);
  run(100ms, {arm, camera});
  lives[hand].process->had += 100s;
  guard.forget(hand);
  run(250ms, {camera});
  EXPECT_THAT(kinds(arm), ElementsAre(cycle_hangs));
}

TEST_F(GuardTest, AMemberWhoseStateIsDamagedHasNotStoppedUntilItIsEnded) {
  cycling(hand);
  run(50ms);
  reinterpret_cast<std::uint32_t*>(lives[hand].vital)[offsetof(VitalPage, state) / 4] ^= 1U;
  const auto stop = guard.stop_all();
  run(200ms);
  EXPECT_FALSE(guard.stop_outcome(stop)) << "though it knows of the stop";
  run(100ms);
  EXPECT_TRUE(lives[hand].process->killed);
  guard.forget(hand);
  start(hand);
  run(50ms);
  ASSERT_TRUE(guard.stop_outcome(stop));
  EXPECT_TRUE(guard.stop_outcome(stop)->at(1).killed);
}

TEST_F(GuardTest, ADeviceThatNeverSaidAnythingIsNoReasonToEndItsMember) {
  cycling(arm);
  lives[arm].vital->inhibited = inhibited_by_stop;
  run(50ms, {arm, hand, camera}, std::nullopt);
  const auto stop = guard.stop_all();
  run(1s, {arm, hand, camera}, std::nullopt);
  EXPECT_TRUE(guard.stop_outcome(stop));
  EXPECT_FALSE(lives[arm].process->killed);
}

TEST_F(GuardTest, AStopEndsWhenTheTimeOfItsDevicesHasPassedAndNotLater) {
  cycling(arm);
  run(50ms);
  const TimePoint begun = clock.now();
  const auto stop = guard.stop_all();
  lives[arm].vital->inhibited = inhibited_by_stop;
  lives[arm].vital->seen_epoch = lives[arm].permit->epoch.load();
  while (!guard.stop_outcome(stop) && clock.now() - begun < 2s) run(Guard::period, {arm, hand, camera}, std::nullopt);
  const Duration stop_within = mission.subsystems[0].subsystem.devices[0].stop_within;
  // The step that sees it is the one that begins then.
  EXPECT_EQ(clock.now() - begun, stop_within + 250ms + Guard::period);
}

TEST_F(GuardTest, OneDeviceThatHasStoppedDoesNotStandForTheOther) {
  auto described = mission.subsystems[1];
  for (const char* name : {"LEFT", "RIGHT"}) {
    described.subsystem.devices.push_back(mission.subsystems[0].subsystem.devices[0]);
    described.subsystem.devices.back().name = described.subsystem.devices.back().enable->address = name;
  }
  Guard second{{.clock = clock, .flows = flows, .on_finding = {}}};
  ASSERT_TRUE(second.add(described, false));
  LaunchedSubsystem launched;
  launched.vital = lives[hand].vital_memory;
  launched.permit = lives[hand].permit_memory;
  launched.grip = lives[hand].process;
  second.started(hand, launched);
  const auto open = [&](const char* name) {
    return flows.open({Transfer::SharedMemory, name}, FlowSide::Device).value();
  };
  const auto left = open("LEFT"), right = open("RIGHT");
  const auto stop = second.stop_all();
  for (int i = 0; i < 120; ++i) {
    ++lives[hand].vital->service_steps;
    static_cast<void>(second.step(clock.now()));
    for (const auto* device : {&left, &right}) {
      std::array<std::byte, enable_frame_octets> frame;
      static_cast<void>((*device)->receive(frame));
      const auto command = read_enable_command(frame).value();
      static_cast<void>((*device)->send(
          *write_enable_status(frame, {.output = device == &left ? DeviceOutput::Off : DeviceOutput::Active,
                                       .flags = 0,
                                       .epoch = 0,
                                       .sequence = command.sequence})));
    }
    clock.advance(Guard::period);
  }
  EXPECT_FALSE(second.stop_outcome(stop));
  EXPECT_TRUE(lives[hand].process->killed) << "it says that it rests, its right arm moves";
}

TEST_F(GuardTest, ASupervisorThatHasNotBegunDoesNotStandStill) {
  Guard second{{.clock = clock, .flows = flows, .on_finding = {}}};
  for (int i = 0; i < 1'000; ++i) {
    static_cast<void>(second.step(clock.now()));
    clock.advance(Guard::period);
  }
  EXPECT_THAT(second.take_findings(), IsEmpty());
}

}  // namespace
}  // namespace hirosco::supervisor
