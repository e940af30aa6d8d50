// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/testing/sealed.hpp"
#include "supervisor/guard/testing/guard_rig.hpp"

/// What the guard counts as time, and whom it blames for a service loop that stands still.
namespace hirosco::supervisor {
namespace {

using testing::arm;
using testing::camera;
using ::testing::ElementsAre;
using testing::GuardTest;
using testing::hand;
using ::testing::IsEmpty;
using Found = GuardFinding::Kind;

struct Watching : GuardTest {
  void SetUp() override {
    GuardTest::SetUp();
    lives[arm].vital->configuration = 2;  // 1 ms
    for (const std::uint16_t apid : {arm, hand, camera}) {
      cycling(apid);
      ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
    }
    run(100ms);
  }
  void step() {
    static_cast<void>(guard.step(clock.now()));
    clock.advance(Guard::period);
  }
  /// The guard steps, everybody moves but the supervisor.
  void without_supervisor(Duration span) {
    for (const TimePoint end = clock.now() + span; clock.now() < end;) {
      for (auto& [apid, life] : lives) {
        life.vital->cycles += 5;
        life.vital->seen_epoch = life.permit->epoch.load();
        ++life.vital->service_steps;
      }
      step();
    }
  }
  /// All go on, but the service loop of one stands; the other's loops have this share of a processor.
  void stands(std::uint16_t one, std::uint16_t other, Duration span, double share) {
    for (const TimePoint end = clock.now() + span; clock.now() < end;) {
      lives[other].process->loops.realtime += std::chrono::duration_cast<Duration>(Guard::period * share);
      --lives[one].vital->service_steps;
      run(Guard::period);
    }
  }
  /// The guard stands, and all others go on: what they do nobody hears.
  void without_guard(Duration span) {
    clock.advance(span);
    for (auto& [apid, life] : lives) {
      life.vital->cycles += static_cast<std::uint64_t>(span / 1ms);
      life.vital->seen_epoch = life.permit->epoch.load();
      ++life.vital->service_steps;
    }
    guard.beat();  // of a supervisor that had stood with it
    step();
  }
  void arm_stands(Duration span, double share) { stands(arm, hand, span, share); }
  void expect_all_may_move() {
    for (const std::uint16_t apid : {arm, hand, camera}) EXPECT_TRUE(may_move(apid)) << apid;
    EXPECT_EQ(told.enabled, 1);
    EXPECT_THAT(guard.take_findings(), IsEmpty());
  }
};

TEST_F(Watching, ASecondInhibitThatDoesNotAnswerIsToldOnceForEachSilence) {
  const auto silent = [&](Duration span) { run(span, {arm, hand, camera}, std::nullopt); };
  silent(inhibit_silence - 2 * Guard::period);
  EXPECT_THAT(kinds(arm), IsEmpty());
  silent(4 * Guard::period);
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitSilent));
  silent(5s);
  EXPECT_THAT(kinds(arm), IsEmpty()) << "once";
  run(100ms);
  silent(inhibit_silence + 2 * Guard::period);
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitSilent)) << "another silence";
}

TEST_F(Watching, ASecondInhibitThatAnswersByFramesOfAnotherVersionCountsAsSilentAndIsToldByThatName) {
  std::array<std::byte, enable_frame_octets> frame{};
  for (const TimePoint end = clock.now() + inhibit_silence + 2 * Guard::period; clock.now() < end;) {
    ASSERT_TRUE(write_enable_status(
        frame, {.output = DeviceOutput::Active, .flags = 0, .epoch = 0, .sequence = told.sequence}));
    static_cast<void>(motor->send(hirosco::testing::sealed_as(0x5A, frame)));
    run(Guard::period, {arm, hand, camera}, std::nullopt);
  }
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitOfOtherVersion));
}

TEST_F(Watching, ASecondInhibitThatStaysSilentIsToldAgainToWhoLetsItMoveAgain) {
  const auto silent = [&](Duration span) { run(span, {arm, hand, camera}, std::nullopt); };
  silent(2s);
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitSilent));
  guard.fence(arm);
  silent(5s);
  EXPECT_THAT(kinds(arm), IsEmpty()) << "it may not move";
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  silent(2s);
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitSilent));
  start(arm);
  lives[arm].vital->configuration = 2;
  cycling(arm);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  silent(2s);
  EXPECT_THAT(kinds(arm), ElementsAre(Found::InhibitSilent)) << "another process";
}

TEST_F(Watching, WhoMayNotActOrDoesNotUseTheDeviceIsToldNothingOfItsSecondInhibit) {
  lives[arm].vital->configuration = 0;
  run(5s, {arm, hand, camera}, std::nullopt);
  EXPECT_THAT(kinds(arm), IsEmpty());
  lives[arm].vital->configuration = 2;
  guard.fence(arm);
  run(5s, {arm, hand, camera}, std::nullopt);
  EXPECT_THAT(kinds(arm), IsEmpty());
}

TEST_F(Watching, APauseOfTheWholeComputerIsNobodysFault) {
  for (const Duration pause : {1s, 2s, 5s, 60s}) {
    clock.advance(pause);
    step();  // it is the first that runs again
    run(50ms);
    expect_all_may_move();
    run(2s);
  }
  expect_all_may_move();
}

TEST_F(Watching, ASupervisorThatStandsStillIsSeenAfterASecondOfTheGuardsSteps) {
  without_supervisor(Guard::supervisor_limit - 2 * Guard::period);
  EXPECT_THAT(kinds(0), IsEmpty());
  without_supervisor(4 * Guard::period);
  EXPECT_THAT(kinds(0), ElementsAre(Found::SupervisorStill));
  EXPECT_FALSE(may_move(arm));
}

TEST_F(Watching, APauseAddsLittleToTheTimeThatASupervisorStoodStillAndTakesNothingFromIt) {
  without_supervisor(Guard::supervisor_limit / 2);
  clock.advance(10s);
  without_supervisor(Guard::supervisor_limit / 2 - Guard::most_unwatched - 2 * Guard::period);
  EXPECT_THAT(kinds(0), IsEmpty());
  without_supervisor(Guard::most_unwatched + 4 * Guard::period);
  EXPECT_THAT(kinds(0), ElementsAre(Found::SupervisorStill));
}

TEST_F(Watching, WhileACycleGoesOnTimeCountsThoughTheGuardItselfStood) {
  clock.advance(Guard::supervisor_limit + 100ms);
  lives[arm].vital->cycles += 800;
  step();
  EXPECT_THAT(kinds(0), ElementsAre(Found::SupervisorStill)) << "its process was stopped, and the arm was not";
  EXPECT_FALSE(may_move(arm));
}

TEST_F(Watching, ACycleThatRestsOrIsGoneDoesNotGoOn) {
  lives[arm].vital->cycling = 0;
  lives[arm].vital->cycles += 10'000;
  clock.advance(Guard::supervisor_limit + 100ms);
  step();
  EXPECT_THAT(kinds(0), IsEmpty());
  run(20ms);
  guard.forget(arm);
  clock.advance(Guard::supervisor_limit + 100ms);
  step();
  EXPECT_THAT(kinds(0), IsEmpty());
}

TEST_F(Watching, ManyStepsThatComeLateCountInFull) {
  for (int i = 0; i < 60; ++i) {
    clock.advance(Guard::most_unwatched - Guard::period);
    without_supervisor(Guard::period);
  }
  EXPECT_THAT(kinds(0), ElementsAre(Found::SupervisorStill));
}

TEST_F(Watching, APermissionDoesNotLapseDuringAPause) {
  guard.fence(arm);
  cycling(arm, State::SafeOperational);
  run(20ms);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(20ms);
  clock.advance(2 * Guard::entry_limit);
  step();
  EXPECT_TRUE(may_move(arm));
  run(Guard::entry_limit);
  EXPECT_FALSE(may_move(arm));
}

TEST_F(Watching, AStopGrantsTheTimeThatWasWatchedAndTellsTheTimeThatPassed) {
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  const auto stop = guard.stop_all();
  for (const std::uint16_t apid : {arm, hand}) lives[apid].vital->inhibited = inhibited_by_stop;
  run(50ms, {arm, hand, camera}, DeviceOutput::Stopping);
  clock.advance(3s);
  step();
  run(50ms, {arm, hand, camera}, DeviceOutput::Stopping);
  EXPECT_FALSE(lives[arm].process->killed) << "nobody could stop meanwhile";
  run(20ms, {arm, hand, camera}, DeviceOutput::Holding);
  const auto answers = guard.stop_outcome(stop);
  ASSERT_TRUE(answers);
  EXPECT_GE(answers->at(0).stopped.value(), 3s);
  EXPECT_LE(answers->at(1).stopped.value(), 10ms);
}

TEST_F(Watching, AStopThatIsNotObeyedEndsAsSoonAfterAPause) {
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  static_cast<void>(guard.stop_all());
  clock.advance(3s);
  step();
  run(400ms, {arm, hand, camera}, DeviceOutput::Active);
  EXPECT_FALSE(lives[arm].process->killed);
  run(60ms, {arm, hand, camera}, DeviceOutput::Active);
  EXPECT_TRUE(lives[arm].process->killed);
}

TEST_F(Watching, AStopEndsNobodyForTimeInWhichTheGuardAskedNobody) {
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  const auto stop = guard.stop_all();
  for (const std::uint16_t apid : {arm, hand}) lives[apid].vital->inhibited = inhibited_by_stop;
  run(20ms, {arm, hand, camera}, DeviceOutput::Stopping);
  without_guard(1s);
  run(10ms, {arm, hand, camera}, DeviceOutput::Holding);
  EXPECT_FALSE(lives[arm].process->killed) << "it has stood still for most of that second";
  const auto answers = guard.stop_outcome(stop);
  ASSERT_TRUE(answers);
  EXPECT_GE(answers->at(0).stopped.value(), 1s) << "that is when it could be heard";
}

TEST_F(Watching, WhoGoesOnMovingHasItsLimitAndTheTimeInWhichNobodyWasAskedAndNoMore) {
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  static_cast<void>(guard.stop_all());
  const TimePoint asked = clock.now();
  constexpr Duration limit = 450ms, pause = 100ms;  // of the motor: 200 ms and the time to answer
  Duration unasked{};
  while (!lives[arm].process->killed && clock.now() < asked + 60s) {
    without_guard(pause);
    unasked += pause + Guard::period - Guard::most_unwatched;
    run(30ms, {arm, hand, camera}, DeviceOutput::Active);
    EXPECT_EQ(lives[arm].process->killed, clock.now() - asked - unasked >= limit + Guard::period);
  }
}

TEST_F(Watching, AStopThatIsAskedForWhileTheGuardStandsGrantsTheTimeFromThenOn) {
  run(50ms, {arm, hand, camera}, DeviceOutput::Active);
  clock.advance(5s);
  lives[arm].vital->cycles += 5000;
  static_cast<void>(guard.stop_all());
  without_guard(0ms);
  run(430ms, {arm, hand, camera}, DeviceOutput::Active);
  EXPECT_FALSE(lives[arm].process->killed);
  run(40ms, {arm, hand, camera}, DeviceOutput::Active);
  EXPECT_TRUE(lives[arm].process->killed);
}

TEST_F(Watching, WhoHangsIsNotEndedForTimeInWhichNobodyTookItsWordAcross) {
  run(250ms, {arm, camera});
  EXPECT_THAT(kinds(hand), ElementsAre(Found::CycleHangs));
  // Its page is a copy that the supervisor keeps up, which stood with the guard.
  clock.advance(Guard::grace + 1s);
  lives[arm].vital->cycles += 2000;
  step();
  EXPECT_FALSE(lives[hand].process->killed);
  run(20ms);
  EXPECT_THAT(kinds(hand), ElementsAre(Found::Back));
}

TEST_F(Watching, WhoseServiceLoopHangsIsNotEndedForThatTimeEitherButWhosePageIsDamagedIs) {
  arm_stands(Guard::service_limit + 50ms, 0);
  EXPECT_THAT(kinds(arm), ElementsAre(Found::ServiceHangs));
  lives[hand].vital->magic ^= 1U;
  run(Guard::observation_period);
  EXPECT_THAT(kinds(hand), ElementsAre(Found::PageDamaged));
  clock.advance(Guard::grace + 1s);
  lives[arm].vital->cycles += 2000;  // a cycle went on: the time was watched
  step();
  EXPECT_FALSE(lives[arm].process->killed) << "nobody could see it move meanwhile";
  EXPECT_TRUE(lives[hand].process->killed) << "it has no way back that somebody could see";
}

TEST_F(Watching, AServiceLoopThatGetsNoProcessorIsNotBlamedButWhoHasIt) {
  lives[arm].process->loops.runnable = true;
  arm_stands(Guard::service_limit + 50ms, 0.9);
  EXPECT_TRUE(may_move(arm));
  EXPECT_FALSE(lives[hand].process->loops_realtime);
  EXPECT_TRUE(lives[hand].process->realtime) << "its cycle goes on as it was";
  EXPECT_TRUE(may_move(hand));
  auto found = guard.take_findings();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, Found::Starves);
  EXPECT_EQ(found[0].apid, hand);
  run(5s);
  expect_all_may_move();
  EXPECT_FALSE(lives[arm].process->killed || lives[hand].process->killed);
}

TEST_F(Watching, WhoHasTheProcessorIsFoundWhereverItStandsInTheMission) {
  lives[hand].process->loops.runnable = true;
  stands(hand, arm, Guard::service_limit + 50ms, 0.9);
  EXPECT_TRUE(may_move(hand));
  EXPECT_FALSE(lives[arm].process->loops_realtime);
  EXPECT_THAT(kinds(arm), ElementsAre(Found::Starves));
}

TEST_F(Watching, ASlowCycleThatStandsHangsAfterThreeOfItsSteps) {
  for (auto& configuration : mission.subsystems[0].subsystem.configurations) configuration.sampling = 200ms;
  run(550ms, {hand, camera});
  EXPECT_THAT(kinds(arm), IsEmpty());
  run(100ms, {hand, camera});
  EXPECT_THAT(kinds(arm), ElementsAre(Found::CycleHangs));
}

TEST_F(Watching, AStarvedLoopThatStandsOnThoughNobodyHasItsProcessorHangs) {
  lives[arm].process->loops.runnable = true;
  arm_stands(Guard::service_limit + 50ms, 0.9);
  static_cast<void>(guard.take_findings());
  arm_stands(Guard::service_limit - 100ms, 0);
  EXPECT_THAT(kinds(arm), IsEmpty()) << "it has its time anew";
  arm_stands(100ms, 0);
  EXPECT_THAT(kinds(arm), ElementsAre(Found::ServiceHangs));
}

TEST_F(Watching, WhoseServiceLoopWaitsForSomethingElseOrRunsOrIsKeptByNobodyHangs) {
  struct Case {
    const char* says;
    bool runnable;
    double own_share, share;
  };
  for (const Case& c : {Case{"it sleeps", false, 0, 0.9}, Case{"it has a fifth itself", true, 0.2, 0.9},
                        Case{"the other has less than half", true, 0, 0.4}}) {
    start(arm);
    lives[hand].process->loops.realtime += 1'000s;  // of its past
    run(50ms);
    lives[arm].process->loops.runnable = c.runnable;
    for (int i = 0; i < (Guard::service_limit + 50ms) / Guard::period; ++i) {
      lives[arm].process->loops.service += std::chrono::duration_cast<Duration>(Guard::period * c.own_share);
      arm_stands(Guard::period, c.share);
    }
    EXPECT_THAT(kinds(arm), ElementsAre(Found::ServiceHangs)) << c.says;
    EXPECT_TRUE(lives[hand].process->loops_realtime) << c.says;
  }
}

TEST_F(Watching, OneThatKeepsTheProcessorFromOthersAgainIsEnded) {
  lives[arm].process->loops.runnable = true;
  arm_stands(2 * Guard::service_limit + 100ms, 0.9);
  EXPECT_THAT(kinds(hand), ElementsAre(Found::Starves, Found::Starves));
  EXPECT_FALSE(may_move(hand));
  EXPECT_TRUE(may_move(arm));
  run(Guard::grace + 50ms);
  EXPECT_TRUE(lives[hand].process->killed);
  EXPECT_FALSE(lives[arm].process->killed);
}

/// The same process, but nobody can do anything to it.
void without_grip(Watching& test, std::uint16_t apid) {
  test.start(apid);
  test.guard.forget(apid);
  LaunchedSubsystem launched;
  launched.vital = test.lives[apid].vital_memory;
  launched.permit = test.lives[apid].permit_memory;
  test.guard.started(apid, launched);
}

TEST_F(Watching, WhoIsGoneOrEndedAlreadyOrCannotBeGrippedIsNotBlamedForAStarvedLoop) {
  const auto expect_arm_hangs = [&](const char* why) {
    EXPECT_THAT(kinds(arm), ElementsAre(Found::ServiceHangs)) << why;
    EXPECT_TRUE(lives[hand].process->loops_realtime) << why;
    for (const std::uint16_t apid : {arm, hand}) {
      guard.forget(apid);
      start(apid);
      cycling(apid);
    }
    run(50ms);
    lives[arm].process->loops.runnable = true;
  };
  lives[arm].process->loops.runnable = true;
  arm_stands(Guard::service_limit - 100ms, 0.9);
  guard.forget(hand);
  arm_stands(150ms, 0.9);
  expect_arm_hangs("gone");
  arm_stands(Guard::service_limit - 100ms, 0.9);
  reinterpret_cast<std::uint32_t*>(lives[hand].vital)[0] ^= 1U;
  lives[hand].process->loops_realtime = true;
  arm_stands(150ms, 0.9);
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_THAT(kinds(arm), ElementsAre(Found::ServiceHangs)) << "the other is ended already";
  guard.forget(arm);
  start(arm);
  without_grip(*this, hand);
  run(50ms);
  lives[arm].process->loops.runnable = true;
  arm_stands(Guard::service_limit + 50ms, 0.9);
  expect_arm_hangs("nobody can ask it");
}

TEST_F(Watching, AServiceLoopOfWhichNobodyKnowsWhatItHadHangs) {
  without_grip(*this, arm);
  run(50ms);
  arm_stands(Guard::service_limit + 50ms, 0.9);
  EXPECT_THAT(kinds(arm), ElementsAre(Found::ServiceHangs));
  EXPECT_TRUE(lives[hand].process->loops_realtime);
}

TEST_F(Watching, RealTimeThatWasTakenComesBackWithTheNextReleaseAndUntilThenTheReducedLimitHolds) {
  mission.subsystems[1].subsystem.hang = {20, 40};
  const auto hand_spins = [&](Duration span) {
    for (const TimePoint end = clock.now() + span; clock.now() < end;) {
      lives[hand].process->had += Guard::period;
      run(Guard::period, {arm, camera});
    }
  };
  hand_spins(250ms);
  EXPECT_THAT(kinds(hand), ElementsAre(Found::CycleHangs));
  run(100ms);
  EXPECT_THAT(kinds(hand), ElementsAre(Found::Back));
  EXPECT_FALSE(lives[hand].process->realtime);
  run(250ms, {arm, camera});
  EXPECT_THAT(kinds(hand), IsEmpty()) << "an ordinary thread may be late";
  run(100ms);
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  EXPECT_TRUE(lives[hand].process->realtime);
  run(20ms);
  run(250ms, {arm, camera});
  EXPECT_THAT(kinds(hand), ElementsAre(Found::CycleHangs));
}

TEST_F(Watching, ANewProcessHasTheLimitsOfOneWhoseRealTimeNobodyTook) {
  mission.subsystems[1].subsystem.hang = {20, 40};
  for (int i = 0; i < 50; ++i) {
    lives[hand].process->had += Guard::period;
    run(Guard::period, {arm, camera});
  }
  EXPECT_THAT(kinds(hand), ElementsAre(Found::CycleHangs));
  guard.forget(hand);
  start(hand);
  cycling(hand);
  run(50ms);
  run(250ms, {arm, camera});
  EXPECT_THAT(kinds(hand), ElementsAre(Found::CycleHangs));
}

TEST_F(Watching, WhoWaitedForTheProcessorHasItsWholeLimitAnewAndNoMore) {
  mission.subsystems[0].subsystem.hang = mission.subsystems[1].subsystem.hang = {20, 40};
  std::map<std::uint16_t, TimePoint> hung;
  while (hung.size() < 2) {
    const TimePoint looks_at = clock.now();
    run(Guard::period, {camera});
    for (const auto& finding : guard.take_findings())
      if (finding.kind == Found::CycleHangs) hung[finding.apid] = looks_at;
    ASSERT_LT(hung.size(), 3u);
  }
  // The look that found the first is already the first of the 20 that the second has anew.
  EXPECT_EQ(hung[hand] - hung[arm], 19 * Guard::observation_period);
}

TEST_F(Watching, OneAnswerToTheFirstCommandAfterAStopIsEnough) {
  run(20ms, {arm, hand, camera}, DeviceOutput::Active);
  const auto stop = guard.stop_all();
  for (const std::uint16_t apid : {arm, hand}) lives[apid].vital->inhibited = inhibited_by_stop;
  run(Guard::period, {arm, hand, camera}, DeviceOutput::Off);
  run(20ms, {arm, hand, camera}, std::nullopt);
  const auto answers = guard.stop_outcome(stop);
  ASSERT_TRUE(answers) << "it needs no second one";
  EXPECT_TRUE(answers->at(0).stopped);
}

}  // namespace
}  // namespace hirosco::supervisor
