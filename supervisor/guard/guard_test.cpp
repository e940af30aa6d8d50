// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/guard.hpp"

#include "supervisor/guard/testing/guard_rig.hpp"

namespace hirosco::supervisor {
namespace {

using testing::arm;
using testing::camera;
using testing::damages;
using ::testing::ElementsAre;
using testing::GuardTest;
using testing::hand;
using testing::Life;
using Kind = GuardFinding::Kind;
using namespace std::chrono_literals;

TEST_F(GuardTest, NothingIsPermittedBeforeARelease) {
  run(20ms);
  for (const std::uint16_t apid : {arm, hand, camera}) EXPECT_FALSE(may_move(apid));
  EXPECT_EQ(told.enabled, 0);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(20ms);
  EXPECT_TRUE(may_move(arm));
  EXPECT_FALSE(may_move(hand));
  EXPECT_EQ(told.enabled, 1);
  EXPECT_EQ(told.epoch, lives[arm].permit->epoch.load());
}

TEST_F(GuardTest, AReleaseThatWasPermittedBeforeAFenceIsVoid) {
  const auto seen = guard.fences(arm);
  guard.fence(arm);
  EXPECT_FALSE(guard.release(arm, seen));
  EXPECT_FALSE(may_move(arm));
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(guard.release(arm, guard.fences(arm)));
  EXPECT_TRUE(may_move(arm));
}

TEST_F(GuardTest, EveryFenceReleaseAndNewProcessRaisesTheEpoch) {
  auto last = lives[arm].permit->epoch.load();
  EXPECT_GT(last, 1000u);
  const auto expect_higher = [&] {
    const auto now = lives[arm].permit->epoch.load();
    EXPECT_GT(now, last);
    last = now;
  };
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  expect_higher();
  guard.fence(arm);
  expect_higher();
  guard.forget(arm);
  start(arm);
  expect_higher();
  EXPECT_EQ(guard.highest_epoch(), last);
}

TEST_F(GuardTest, APermissionEndsWithTheStayInOperational) {
  cycling(arm, State::SafeOperational);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(20ms);
  cycling(arm, State::Operational);
  run(5s);
  EXPECT_TRUE(may_move(arm));
  EXPECT_EQ(told.enabled, 1);
  cycling(arm, State::SafeOperational);
  run(20ms);
  EXPECT_FALSE(may_move(arm));
  EXPECT_EQ(told.enabled, 0);
}

TEST_F(GuardTest, APermissionThatIsNotUsedLapses) {
  cycling(arm, State::SafeOperational);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(Guard::entry_limit + 10ms);
  EXPECT_FALSE(may_move(arm));
}

TEST_F(GuardTest, APermissionWaitsForTheStepsOfASlowCycle) {
  descriptor::Configuration slow;
  slow.id = 2;
  slow.sampling = 3s;
  mission.subsystems[1].subsystem.configurations = {slow};
  lives[hand].vital->configuration = 2;
  cycling(hand, State::SafeOperational);
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  run(9s - 10ms);
  EXPECT_TRUE(may_move(hand)) << "it enters with one of its next steps";
  run(20ms);
  EXPECT_FALSE(may_move(hand));
}

TEST_F(GuardTest, OneThatStandsStillIsFencedToldAndEndedAfterTheGrace) {
  cycling(arm);
  cycling(hand);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(50ms);
  run(190ms, {hand, camera});
  EXPECT_TRUE(kinds(arm).empty());
  run(40ms, {hand, camera});
  EXPECT_THAT(kinds(arm), ElementsAre(Kind::CycleHangs));
  EXPECT_FALSE(may_move(arm));
  EXPECT_TRUE(lives[arm].process->realtime) << "it takes nothing from anybody";
  EXPECT_FALSE(lives[arm].process->killed);
  run(Guard::grace, {hand, camera});
  EXPECT_THAT(kinds(arm), ElementsAre(Kind::Killed));
  EXPECT_TRUE(lives[arm].process->killed);
  EXPECT_TRUE(kinds(hand).empty());
}

TEST_F(GuardTest, OneThatComesBackInTimeLivesOnButStaysFenced) {
  cycling(arm);
  run(50ms);
  run(250ms, {hand, camera});
  EXPECT_THAT(kinds(arm), ElementsAre(Kind::CycleHangs));
  run(2s);
  EXPECT_THAT(kinds(arm), ElementsAre(Kind::Back));
  EXPECT_FALSE(lives[arm].process->killed);
  EXPECT_TRUE(guard.fenced(arm));
}

TEST_F(GuardTest, OfThoseThatStandStillTheOneThatHasTheProcessorIsTheCulprit) {
  cycling(arm);
  cycling(hand);
  run(50ms);
  for (int i = 0; i < 23; ++i) {
    lives[hand].process->had += 10ms;
    run(10ms, {camera});
  }
  EXPECT_TRUE(kinds(arm).empty());
  EXPECT_FALSE(lives[hand].process->realtime);
  EXPECT_TRUE(lives[arm].process->realtime);
  run(Guard::grace + 50ms, {arm, camera});
  EXPECT_TRUE(lives[hand].process->killed);
  EXPECT_FALSE(lives[arm].process->killed);
}

TEST_F(GuardTest, AServiceLoopThatStandsStillIsAHang) {
  cycling(arm);
  run(100ms);
  for (Duration span{}; span < Guard::service_limit + 50ms; span += Guard::period) {
    --lives[arm].vital->service_steps;
    run(Guard::period);
  }
  EXPECT_THAT(kinds(arm), ElementsAre(Kind::ServiceHangs));
  EXPECT_TRUE(guard.fenced(arm));
}

TEST_F(GuardTest, AVitalPageThatIsOverwrittenIsAHangWhateverIsWritten) {
  for (std::size_t at = 0; at < offsetof(VitalPage, seen_epoch); at += 4) {
    if (at >= offsetof(VitalPage, inhibited)) break;
    start(arm);
    cycling(arm);
    run(50ms);
    static_cast<void>(kinds(arm));
    reinterpret_cast<std::uint32_t*>(lives[arm].vital)[at / 4] ^= 1U << 3;
    run(15ms);
    EXPECT_THAT(kinds(arm), ElementsAre(Kind::PageDamaged)) << at;
    EXPECT_TRUE(guard.fenced(arm));
    run(Guard::grace + 10ms);
    EXPECT_TRUE(lives[arm].process->killed) << at;
  }
}

TEST_F(GuardTest, OneThatGoesOnAndDoesNotLookAtItsPermitPageIsToldAndEnded) {
  for (const std::uint16_t apid : {arm, hand}) cycling(apid);
  run(50ms);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(1s);
  EXPECT_THAT(kinds(arm), ElementsAre());
  looks = false;  // from one cycle to the next it reads a page of its own
  run(1s);
  EXPECT_THAT(kinds(arm), ElementsAre()) << "it has seen all that it was told so far";
  guard.fence(arm);
  run(150ms);
  EXPECT_THAT(kinds(arm), ElementsAre());
  run(100ms);
  EXPECT_THAT(kinds(arm), ElementsAre(Kind::PageDamaged)) << "after its limit of 20 observations";
  run(Guard::grace + 10ms);
  EXPECT_TRUE(lives[arm].process->killed);
  EXPECT_FALSE(lives[hand].process->killed) << "whom nobody told anything new";
}

TEST_F(GuardTest, ADamagedEpochIsNeitherTakenOverNorKept) {
  for (const std::uint32_t damaged : damages(lives[arm].permit->epoch.load())) {
    start(arm);
    run(20ms);
    const std::uint32_t before = guard.highest_epoch();
    lives[arm].permit->epoch.store(damaged);
    guard.fence(arm);
    EXPECT_GT(lives[arm].permit->epoch.load(), before - 10) << "a device would not hear of a lower one";
    EXPECT_LE(guard.highest_epoch(), before + 10) << "they are not used up";
    start(arm);
  }
}

TEST_F(GuardTest, AStopOfEverythingIsAnsweredByTheDevicesAndSparesTheGroundLink) {
  for (const std::uint16_t apid : {arm, hand, camera}) {
    cycling(apid);
    ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  }
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  const auto stop = guard.stop_all();
  EXPECT_FALSE(may_move(arm));
  EXPECT_FALSE(may_move(hand));
  EXPECT_TRUE(may_move(camera));
  EXPECT_FALSE(guard.stop_outcome(stop));
  lives[hand].vital->inhibited = inhibited_by_stop;
  lives[hand].vital->seen_epoch = lives[hand].permit->epoch.load();
  run(100ms, {arm, hand, camera}, DeviceOutput::Stopping);
  EXPECT_FALSE(guard.stop_outcome(stop)) << "it is still stopping";
  run(20ms, {arm, hand, camera}, DeviceOutput::Holding);
  const auto answers = guard.stop_outcome(stop);
  ASSERT_TRUE(answers);
  ASSERT_EQ(answers->size(), 2u);
  EXPECT_EQ(answers->at(0).name, "MOTOR");
  EXPECT_TRUE(answers->at(0).asked_device);
  EXPECT_GE(answers->at(0).stopped.value(), 100ms);
  EXPECT_EQ(answers->at(1).name, "HAND");
  EXPECT_LE(answers->at(1).stopped.value(), 10ms);
}

/// ARM's motor is one that keeps its position, as its descriptor says.
struct MotorThatHolds : GuardTest {
  MotorThatHolds() { mission.subsystems[0].subsystem.devices[0].stop = descriptor::StopKind::Hold; }
  /// What is told of how it rests after a stop.
  std::string_view told_when_it_rests(DeviceOutput output) {
    run(50ms, {arm, hand, camera}, DeviceOutput::Active);
    const auto stop = guard.stop_all();
    lives[arm].vital->inhibited = inhibited_by_stop;
    run(50ms, {arm, hand, camera}, output);
    const auto answers = guard.stop_outcome(stop);
    EXPECT_TRUE(answers);
    return answers ? answers->at(0).otherwise : "nobody answered";
  }
};

TEST_F(MotorThatHolds, IsToldOfWhereItIsOffAfterAStop) {
  cycling(arm);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  EXPECT_EQ(told_when_it_rests(DeviceOutput::Off), "it is off, and its descriptor declares that it holds");
  lives[arm].vital->inhibited = 0;
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  EXPECT_EQ(told_when_it_rests(DeviceOutput::Holding), "");
}

TEST_F(GuardTest, WhoIsLetGoAgainBeforeTheOthersHaveStoppedIsNotEndedForMovingThen) {
  for (const std::uint16_t apid : {arm, hand}) {
    cycling(apid);
    ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  }
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  const auto stop = guard.stop_all();
  EXPECT_FALSE(guard.release(arm, guard.fences(arm))) << "its motor moves still";
  lives[hand].vital->inhibited = inhibited_by_stop;
  run(50ms, {arm, hand, camera}, DeviceOutput::Stopping);
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  lives[hand].vital->inhibited = 0;
  run(300ms, {arm, hand, camera}, DeviceOutput::Stopping);
  EXPECT_FALSE(lives[hand].process->killed);
  run(20ms, {arm, hand, camera}, DeviceOutput::Holding);
  const auto answers = guard.stop_outcome(stop);
  ASSERT_TRUE(answers);
  EXPECT_TRUE(answers->at(0).stopped);
  EXPECT_LE(answers->at(1).stopped.value(), 50ms) << "it had stopped";
  EXPECT_TRUE(guard.release(arm, guard.fences(arm)));
}

TEST_F(GuardTest, AStopAfterALeaveToGoOnDuringAStopIsOneOfItsOwn) {
  for (const std::uint16_t apid : {arm, hand}) {
    cycling(apid);
    ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  }
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  static_cast<void>(guard.stop_all());
  lives[hand].vital->inhibited = inhibited_by_stop;
  run(50ms, {arm, hand, camera}, DeviceOutput::Stopping);
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  lives[hand].vital->inhibited = 0;
  run(50ms, {arm, hand, camera}, DeviceOutput::Stopping);
  const auto again = guard.stop_all();
  run(240ms, {arm, hand, camera}, DeviceOutput::Holding);
  EXPECT_FALSE(lives[hand].process->killed) << "it has the time of this stop, however long the other one lasts";
  run(460ms, {arm, hand, camera}, DeviceOutput::Holding);
  EXPECT_TRUE(lives[hand].process->killed) << "it does not stop this time";
  EXPECT_TRUE(guard.stop_outcome(again));
}

TEST_F(GuardTest, WhoWasLetGoAndHasLeftAgainDuringAStopStopsForTheNextOneItself) {
  for (const std::uint16_t apid : {arm, hand}) {
    cycling(apid);
    ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  }
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  static_cast<void>(guard.stop_all());
  run(20ms, {arm, hand, camera}, DeviceOutput::Holding);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm))) << "HAND goes on, and the stop is open";
  run(20ms, {arm, hand, camera}, DeviceOutput::Active);
  cycling(arm, State::SafeOperational);
  run(20ms, {arm, hand, camera}, DeviceOutput::Stopping);
  const auto again = guard.stop_all();
  lives[hand].vital->inhibited = inhibited_by_stop;
  run(50ms, {arm, hand, camera}, DeviceOutput::Stopping);
  EXPECT_FALSE(guard.stop_outcome(again)) << "its motor comes to rest only now";
  run(20ms, {arm, hand, camera}, DeviceOutput::Holding);
  const auto answers = guard.stop_outcome(again);
  ASSERT_TRUE(answers);
  EXPECT_TRUE(answers->at(0).stopped);
}

TEST_F(GuardTest, WhatAMemberSaysOfItselfDoesNotStandForItsDevice) {
  cycling(arm);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  const auto stop = guard.stop_all();
  lives[arm].vital->inhibited = inhibited_by_stop;
  lives[arm].vital->seen_epoch = lives[arm].permit->epoch.load();
  run(440ms, {arm, hand, camera}, DeviceOutput::Active);
  EXPECT_FALSE(guard.stop_outcome(stop));
  EXPECT_FALSE(lives[arm].process->killed);
  run(20ms, {arm, hand, camera}, DeviceOutput::Active);
  EXPECT_TRUE(lives[arm].process->killed);
  run(500ms, {arm, hand, camera}, DeviceOutput::Active);
  const auto answers = guard.stop_outcome(stop);
  ASSERT_TRUE(answers);
  EXPECT_EQ(answers->at(0).stopped, std::nullopt);
  EXPECT_TRUE(answers->at(0).killed);
}

TEST_F(GuardTest, ASilentDeviceHasNotStopped) {
  cycling(arm);
  run(50ms);
  const auto stop = guard.stop_all();
  run(2s, {arm, hand, camera}, std::nullopt);
  const auto answers = guard.stop_outcome(stop);
  ASSERT_TRUE(answers);
  EXPECT_EQ(answers->at(0).stopped, std::nullopt);
}

TEST_F(GuardTest, ADeviceThatCannotBeHeardIsNoReasonToEndWhoHasLetGoOfIt) {
  cycling(arm);
  run(50ms);
  const auto stop = guard.stop_all();
  lives[arm].vital->inhibited = inhibited_by_stop;
  lives[arm].vital->seen_epoch = lives[arm].permit->epoch.load();
  run(500ms, {arm, hand, camera}, std::nullopt);
  ASSERT_TRUE(guard.stop_outcome(stop));
  EXPECT_EQ(guard.stop_outcome(stop)->at(0).stopped, std::nullopt);
  EXPECT_FALSE(lives[arm].process->killed);
}

TEST_F(GuardTest, NobodyIsEndedTwiceForOneStop) {
  cycling(arm);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  const auto stop = guard.stop_all();
  run(460ms, {arm, hand, camera}, DeviceOutput::Active);
  EXPECT_TRUE(lives[arm].process->killed);
  guard.forget(arm);
  start(arm);
  run(600ms, {arm, hand, camera}, DeviceOutput::Active);
  EXPECT_FALSE(lives[arm].process->killed);
  EXPECT_TRUE(guard.stop_outcome(stop));
}

TEST_F(GuardTest, StopsInAFloodAllEnd) {
  run(50ms);
  std::vector<std::uint64_t> stops;
  for (int i = 0; i < 200; ++i) {
    stops.push_back(guard.stop_all());
    run(Guard::period);
  }
  run(50ms);
  for (const auto stop : stops) EXPECT_TRUE(guard.stop_outcome(stop)) << stop;
}

TEST_F(GuardTest, ASupervisorThatStandsStillStopsEverythingThatMoves) {
  for (const std::uint16_t apid : {arm, hand, camera}) {
    cycling(apid);
    ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  }
  run(50ms);
  EXPECT_EQ(told.enabled, 1);
  for (Duration span{}; span < Guard::supervisor_limit + 20ms; span += Guard::period) {
    for (auto& [apid, life] : lives) {
      ++life.vital->cycles;
      ++life.vital->service_steps;
    }
    static_cast<void>(guard.step(clock.now()));
    clock.advance(Guard::period);
  }
  for (const std::uint16_t apid : {arm, hand, camera}) EXPECT_FALSE(may_move(apid));
  EXPECT_THAT(kinds(0), ElementsAre(Kind::SupervisorStill));
}

TEST_F(GuardTest, AFloodOfStopsEndsNobodyWhoStopsAndConfirmsEach) {
  cycling(arm);
  cycling(hand);
  for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  run(50ms);
  // A stop with each step of the supervisor: each member sees the epoch of a step before, as its cycle comes later.
  std::vector<std::uint64_t> stops;
  looks = false;
  const auto epoch = guard.highest_epoch();
  for (int i = 0; i < 600; ++i) {
    for (const std::uint16_t apid : {arm, hand}) {
      lives[apid].vital->seen_epoch = lives[apid].permit->epoch.load();
      lives[apid].vital->inhibited = guard.fenced(apid) ? 1 : 0;
    }
    for (int flood = 0; flood < 5; ++flood) stops.push_back(guard.stop_all());
    run(Guard::period);
  }
  looks = true;
  run(500ms);
  for (const std::uint16_t apid : {arm, hand}) EXPECT_FALSE(lives[apid].process->killed) << apid;
  for (const auto stop : stops) {
    const auto outcome = guard.stop_outcome(stop);
    ASSERT_TRUE(outcome);
    for (const StopAnswer& answer : *outcome) EXPECT_TRUE(answer.stopped) << answer.name;
  }
  EXPECT_LE(guard.highest_epoch(), epoch + 2) << "a flood uses up no epochs";
}

TEST_F(GuardTest, AStopGrantsASlowCycleItsOwnStepsBeforeItsMemberIsEnded) {
  descriptor::Configuration slow;
  slow.id = 2;
  slow.sampling = 1s;
  mission.subsystems[1].subsystem.configurations = {slow};
  lives[hand].vital->configuration = 2;
  cycling(hand);
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  run(20ms);
  const auto stop = guard.stop_all();
  run(1s, {});
  EXPECT_FALSE(guard.stop_outcome(stop));
  EXPECT_FALSE(lives[hand].process->killed);
  lives[hand].vital->inhibited = 1;
  run(20ms, {hand});
  EXPECT_FALSE(lives[hand].process->killed);
  EXPECT_TRUE(guard.stop_outcome(stop));
}

}  // namespace
}  // namespace hirosco::supervisor
