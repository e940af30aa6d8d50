// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/plan_runs.hpp"

#include "supervisor/supervision/testing/plans_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

TEST_F(PlanRunsTest, TheHigherPriorityEndsTheLowerAndAnEventNamesBoth) {
  plan("low", "FIRST", 100, {to_be(ErrorOperational), to_be(PostOperational)});
  plan("high", "SECOND", 101, {to_be(PreOperational)});
  happens(first_event);
  const auto begun = received(arm);
  ASSERT_EQ(begun.size(), 1U);
  happens(second_event);
  EXPECT_THAT(texts(arm), ElementsAre(to(PreOperational)));
  EXPECT_TRUE(was_told("ARM: plan low gives way to plan high at ARM: ErrorOperational"));
  own_step();
  EXPECT_TRUE(was_told("PLAN_PREEMPTED APID=10 PLAN=1 BY=2"));
  verify(arm, begun[0].request, 7);
  EXPECT_THAT(texts(arm), IsEmpty()) << "its next step is given up";
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(craft.member(arm)->recovery.running()) << "the other one runs";
}

TEST_F(PlanRunsTest, WhatFailsAfterItGaveWayEscalatesNothing) {
  plan("low", "FIRST", 100, {to_be(ErrorOperational)});
  plan("high", "SECOND", 101, {to_be(PreOperational)});
  happens(first_event);
  const auto begun = received(arm);
  happens(second_event);
  verify(arm, begun.at(0).request, 8, pus::FailureCode::ExecutionError);
  EXPECT_FALSE(was_told("escalating"));
  EXPECT_FALSE(guard.fenced(hand));
}

TEST_F(PlanRunsTest, AnEqualOrLowerOneIsRefusedAndThatIsToldOnce) {
  plan("runs", "FIRST", 100, {to_be(ErrorOperational)});
  plan("equal", "SECOND", 100, {to_be(Offline)});
  happens(first_event);
  answered(hand);
  static_cast<void>(texts(arm));
  for (int again = 0; again < 3; ++again) happens(second_event);
  EXPECT_THAT(texts(arm), IsEmpty());
  own_step();
  const auto told = [&](std::string_view what) {
    return std::ranges::count_if(story, [&](const std::string& line) { return line.find(what) != std::string::npos; });
  };
  EXPECT_EQ(told("ARM: plan equal because of SECOND is refused, plan runs runs"), 1);
  EXPECT_EQ(told("PLAN_REFUSED APID=10 PLAN=2 RUNS=1"), 1);
}

TEST_F(PlanRunsTest, ASecondEventOfAPlanThatRunsBeginsNothingAndThatIsToldOnce) {
  plan("runs", "FIRST", 100, {to_be(ErrorOperational)});
  happens(first_event);
  EXPECT_THAT(texts(arm), ElementsAre(to(ErrorOperational)));
  for (int again = 0; again < 3; ++again) happens(first_event);
  EXPECT_THAT(texts(arm), IsEmpty());
  own_step();
  const auto told = [&](std::string_view what) {
    return std::ranges::count_if(story, [&](const std::string& line) { return line.find(what) != std::string::npos; });
  };
  EXPECT_EQ(told("ARM: plan runs because of FIRST runs already, FIRST does not begin it anew"), 1);
  EXPECT_EQ(told("PLAN_REFUSED APID=10 PLAN=1 RUNS=1"), 1);
}

TEST_F(PlanRunsTest, WhereItsStopIsDoneTheSameEventBeginsAPlanAnewAndThatIsTold) {
  plan("runs", "FIRST", 100, {to_be(SafeOperational), {"command", {0, 0, 15}, {}, {"BRAKE"}}});
  happens(first_event);
  answered(arm);
  EXPECT_THAT(texts(arm), ElementsAre("BRAKE"));
  happens(first_event);
  EXPECT_TRUE(was_told("ARM: plan runs begins anew: FIRST came again while it ran"));
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
}

TEST_F(PlanRunsTest, ARefusedPlanDoesNotBeginLater) {
  plan("runs", "FIRST", 100, {to_be(ErrorOperational)});
  plan("lower", "SECOND", 99, {to_be(PreOperational)});
  happens(first_event);
  happens(second_event);
  obey(arm);
  EXPECT_FALSE(craft.member(arm)->recovery.running());
  EXPECT_THAT(texts(arm), IsEmpty()) << "it would act on what has changed since";
  happens(second_event);
  EXPECT_THAT(texts(arm), ElementsAre(to(PreOperational))) << "told again, it begins";
}

TEST_F(PlanRunsTest, WhatIsSaferGoesFirstWhateverItsNumber) {
  plan("state", "FIRST", 255, {to_be(SafeOperational)});
  plan("network", "SECOND", 1, {down()});
  happens(first_event);
  happens(second_event);
  EXPECT_TRUE(craft.member(arm)->recovery.going_down());
  EXPECT_TRUE(guard.fenced(hand));
}

TEST_F(PlanRunsTest, NothingLessSafeEndsAPlanThatWillStillTakeTheNetworkDown) {
  plan("network", "FIRST", 1, {to_be(SafeOperational), down()});
  plan("state", "SECOND", 255, {to_be(PreOperational)});
  happens(first_event);
  happens(second_event);
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
  EXPECT_TRUE(was_told("ARM: plan state because of SECOND is refused, plan network runs"));
  set(arm, SafeOperational);
  happens(second_event);
  EXPECT_THAT(texts(arm), IsEmpty());
}

TEST_F(PlanRunsTest, WhoGoesDownWithANetworkFollowsNoPlanOfItsOwnAnyMore) {
  plan("own", "FIRST", 255, {to_be(ErrorOperational), to_be(PostOperational)});
  plan("network", "SECOND", 1, {down()});
  happens(first_event, hand);
  happens(second_event, arm);
  EXPECT_TRUE(was_told("HAND: plan own gives way to plan network"));
  std::vector<std::string> sent;
  for (const auto& each : received(hand)) {
    sent.push_back(each.text);
    set(hand, ErrorOperational);
    verify(hand, each.request, 7);
  }
  for (const std::string& each : texts(hand)) sent.push_back(each);
  EXPECT_EQ(std::ranges::count(sent, to(PostOperational)), 0);
  EXPECT_EQ(std::ranges::count(sent, to(Offline)), 1);
}

TEST_F(PlanRunsTest, AStepMayMoveAnotherThanWhoseEventItIs) {
  plan("hand too", "FIRST", 100, {to_be(SafeOperational, "HAND")});
  happens(first_event);
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(texts(hand), ElementsAre(to(SafeOperational)));
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_FALSE(guard.fenced(arm));
  EXPECT_TRUE(was_told("plan hand too: HAND to SafeOperational because of FIRST"));
}

TEST_F(PlanRunsTest, WhomAPlanMovesIsHeldUpByNobodyElseOfIt) {
  plan("both", "FIRST", 100, {to_be(ErrorOperational), to_be(SafeOperational, "HAND")});
  happens(first_event);
  EXPECT_THAT(texts(arm), ElementsAre(to(ErrorOperational)));
  EXPECT_THAT(texts(hand), ElementsAre(to(SafeOperational))) << "though ARM has not answered";
}

TEST_F(PlanRunsTest, AnEscalationIsOneAndWhereThatFailsTooTheNetworkGoesDown) {
  descriptor::Plan severe;
  severe.name = "severe";
  severe.severities = {Severity::High};
  severe.steps = {to_be(PreOperational)};
  craft.mission.plans.push_back(severe);
  plan("fails", "FIRST", 100, {to_be(ErrorOperational)});
  happens(first_event);
  answered(arm, 8);
  EXPECT_EQ(texts(arm).size(), 1U) << "the plan for what is severe";
  EXPECT_FALSE(guard.fenced(hand));
  wait(WaitingForDisk::limit);
  parts.own_telecommands.watch(clock.now());
  EXPECT_TRUE(craft.member(arm)->recovery.going_down());
  EXPECT_TRUE(guard.fenced(hand));
}

TEST(PlanRank, SafetyCountsMoreThanPriorityThanSeverity) {
  const PlanRank runs{Safety::Stop, 100, Severity::Medium};
  EXPECT_TRUE(pre_empts({Safety::Network, 1, Severity::Info}, runs));
  EXPECT_TRUE(pre_empts({Safety::Stop, 101, Severity::Info}, runs));
  EXPECT_TRUE(pre_empts({Safety::Stop, 100, Severity::High}, runs));
  EXPECT_FALSE(pre_empts(runs, runs));
  EXPECT_FALSE(pre_empts({Safety::None, 255, Severity::High}, runs));
  EXPECT_FALSE(pre_empts({Safety::Stop, 99, Severity::High}, runs));
}

}  // namespace
}  // namespace hirosco::supervisor
