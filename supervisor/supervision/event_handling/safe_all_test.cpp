// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/safe_all.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct SafeAllTest : PartsTest {
  void answered() {
    for (const TimePoint end = clock.now() + 1s; clock.now() < end; wait(Guard::period)) guard_sees_all();
    parts.safe_all.follow();
  }
};

TEST_F(SafeAllTest, TheStatesFollowOfWhoActsButNotOfTheGroundLink) {
  start_all(Operational);
  set(hand, SafeOperational);
  parts.safe_all.asked();
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
  EXPECT_THAT(texts(hand), IsEmpty());
  EXPECT_THAT(texts(camera), IsEmpty());
  EXPECT_TRUE(was_told("stop by signal or local socket: every actuator inhibited"));
}

TEST_F(SafeAllTest, TheStateFollowsOfWhoEntersOperationalAfterItHoweverLateAndOnce) {
  start_all(SafeOperational);
  parts.safe_all.asked();
  wait(3600s);  // the longest cycle that a descriptor may have
  parts.safe_all.follow();
  EXPECT_THAT(texts(arm), IsEmpty());
  set(arm, Operational);
  parts.safe_all.follow();
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
  parts.safe_all.follow();
  EXPECT_THAT(texts(arm), IsEmpty()) << "once";
}

TEST_F(SafeAllTest, TheStateOfWhoWasLetGoAfterItStays) {
  start_all(SafeOperational);
  parts.safe_all.asked();
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  parts.safe_all.follow();
  set(arm, Operational);
  guard.fence(arm);  // by a plan, say: its state stays
  parts.safe_all.follow();
  EXPECT_THAT(texts(arm), IsEmpty());
}

TEST_F(SafeAllTest, OneThatNoTelecommandAskedForIsToldToGroundAndNoPlanAnswersIt) {
  descriptor::Plan plan;
  plan.name = "all";
  plan.severities = {descriptor::Severity::Medium};
  plan.steps = {{.kind = "set_state", .values = {static_cast<std::int64_t>(SafeOperational)}}};
  mission.plans = {plan};
  start_supervisor();
  start_all(SafeOperational);
  parts.safe_all.asked();
  for (int step = 0; step < 10; ++step) own_step();
  EXPECT_TRUE(was_told("SUPERVISOR medium LOCAL_STOP"));
  EXPECT_FALSE(was_told("because of LOCAL_STOP"));
  story.clear();
  const auto safe_all = telecommand(supervisor_apid, 8, 1, call_data("SAFE_ALL"));
  parts.telecommands.take({.packet = safe_all, .origin = Origin::ground()});
  for (int step = 0; step < 10; ++step) own_step();
  EXPECT_FALSE(was_told("LOCAL_STOP"));
}

TEST_F(SafeAllTest, TheGuardHasStoppedEverythingBeforeAnythingIsSent) {
  start_all(Operational);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  parts.safe_all.asked();
  EXPECT_TRUE(guard.fenced(arm));
}

TEST_F(SafeAllTest, ItWaitsForNoStateOfTheSupervisorItself) {
  start_all(Operational);
  ASSERT_EQ(parts.own.state(), Offline);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  const auto safe_all = telecommand(supervisor_apid, 8, 1, call_data("SAFE_ALL"));
  parts.telecommands.take({.packet = safe_all, .origin = Origin::ground()});
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(was_told("SAFE_ALL: every actuator inhibited"));
}

TEST_F(SafeAllTest, WhatBecameOfItIsToldWhenAllHaveStopped) {
  start_all(SafeOperational);
  parts.safe_all.asked();
  parts.safe_all.follow();
  EXPECT_FALSE(was_told("everything has stopped"));
  answered();
  EXPECT_TRUE(was_told("everything has stopped"));
}

}  // namespace
}  // namespace hirosco::supervisor
