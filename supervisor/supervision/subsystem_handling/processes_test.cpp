// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/processes.hpp"

#include "hirosco/descriptor/supervisor_events.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using enum descriptor::State;

struct ProcessesTest : PartsTest {
  int starts_that_fail{0};  ///< from now on
  [[nodiscard]] Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& subsystem) override {
    if (starts_that_fail-- > 0) return fail(ErrorCode::SystemFailure, "new process", 11);
    return PartsTest::launch(subsystem);
  }
  void dies(std::uint16_t apid) {
    ends[played[apid].process] = {.by_signal = true, .value = 9};
    parts.processes.watch(clock.now());
    ends.clear();
  }
};

TEST_F(ProcessesTest, EachIsStartedInTheOrderOfTheMission) {
  parts.processes.start_all();
  EXPECT_THAT(story, ElementsAre("started ARM", "started HAND", "started CAMERA"));
  for (const Member& member : craft.members) EXPECT_TRUE(member.alive());
}

TEST_F(ProcessesTest, ADeathIsToldWithItsKindAndItsNetworkGoesDown) {
  start_all(Operational);
  dies(arm);
  EXPECT_FALSE(craft.member(arm)->alive());
  EXPECT_TRUE(was_told("ARM died: signal 9"));
  EXPECT_TRUE(was_told("network {ARM} to ErrorOperational and down"));
}

TEST_F(ProcessesTest, WhatTheDeadHadBegunHasAnUnknownOutcome) {
  start_all(Operational);
  const auto asked = telecommand(arm, 17, 1, {});
  parts.telecommands.take({.packet = asked, .origin = Origin::ground()});
  dies(arm);
  EXPECT_THAT(own_failures(), ElementsAre(static_cast<std::uint16_t>(pus::FailureCode::OutcomeUnknown)));
}

TEST_F(ProcessesTest, WhoLivesOnWithItsChannelClosedIsFencedAndEndedAfterASecond) {
  start_all(Operational);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  played[arm].channel.close_subsystem_end();
  parts.reception.read(*craft.member(arm));
  EXPECT_TRUE(guard.fenced(arm));
  wait(1s);
  parts.processes.watch_closed();
  EXPECT_TRUE(killed.empty());
  wait(1ms);
  parts.processes.watch_closed();
  EXPECT_THAT(killed, ElementsAre(played[arm].process));
}

TEST_F(ProcessesTest, WithWhoClosesItsChannelItsNetworkIsFencedAtOnce) {
  start_all(Operational);
  parts.graph.set_up(2, true);
  for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  played[hand].channel.close_subsystem_end();
  parts.reception.read(*craft.member(hand));
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(craft.member(hand)->alive()) << "before it has ended";
  EXPECT_FALSE(was_told("network {"));
}

TEST_F(ProcessesTest, WhoClosesItsChannelFencesNobodyWhomItsPlanLetsGoOn) {
  start_all(Operational);
  parts.graph.set_up(2, true);
  descriptor::Plan alone;
  alone.name = "alone";
  alone.event = descriptor::event_of_death;
  alone.steps = {{"log"}};
  craft.mission.plans = {alone};
  for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  played[hand].channel.close_subsystem_end();
  parts.reception.read(*craft.member(hand));
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(ProcessesTest, OneThatIsDueIsStartedAgainButNotWhileTheFlightEnds) {
  start_all(Operational);
  dies(hand);
  ASSERT_TRUE(parts.restarts.plan(hand, {.limit = 3, .within = 60s, .pause = 100ms}, clock.now()));
  parts.processes.watch(clock.now());
  EXPECT_FALSE(craft.member(hand)->alive());
  wait(100ms);
  craft.shutting_down = true;
  parts.processes.watch(clock.now());
  EXPECT_FALSE(craft.member(hand)->alive());
  craft.shutting_down = false;
  ASSERT_TRUE(parts.restarts.plan(hand, {.limit = 3, .within = 60s, .pause = 100ms}, clock.now()));
  wait(200ms);
  parts.processes.watch(clock.now());
  EXPECT_TRUE(craft.member(hand)->alive());
}

TEST_F(ProcessesTest, AStartThatFailsIsTriedAgainWithAPauseThatDoubles) {
  start_all(Operational);
  for (const std::uint16_t apid : {hand, camera}) {
    dies(apid);
    ASSERT_TRUE(parts.restarts.plan(apid, {.limit = 1, .within = 600s, .pause = 100ms}, clock.now()));
    starts_that_fail = 3;
    // Tried after 100, 200, 400 and 800 ms.
    for (const Duration pause : {100ms, 200ms, 400ms, 800ms}) {
      EXPECT_FALSE(craft.member(apid)->alive());
      wait(pause - 1ms);
      parts.processes.watch(clock.now());
      EXPECT_FALSE(craft.member(apid)->alive());
      wait(1ms);
      parts.processes.watch(clock.now());
    }
    EXPECT_TRUE(craft.member(apid)->alive()) << craft.name_of(apid);
  }
  EXPECT_TRUE(was_told("cannot start HAND: new process"));
  EXPECT_FALSE(craft.failed);
}

TEST_F(ProcessesTest, AFlightWhoseFirstStartsFailIsNotOrderly) {
  starts_that_fail = 1;
  parts.processes.start_all();
  EXPECT_TRUE(craft.failed);
}

}  // namespace
}  // namespace hirosco::supervisor
