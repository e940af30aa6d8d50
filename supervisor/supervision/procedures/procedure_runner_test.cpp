// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/procedure_runner.hpp"

#include "supervisor/supervision/procedures/steps/step_kinds.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"
#include "supervisor/supervision/testing/played_desk.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using OnFailure = Procedure::OnFailure;
using enum descriptor::State;

/// A kind that the table does not know: what is seen by the runner of any kind, without a word of it in the runner.
/// Values: what it tells when it begins.
constexpr StepKind note_kind{
    .name = "note",
    .values = 1,
    .text = [](const ProcedureStep& step,
               const descriptor::Mission&) { return "note " + std::to_string(step.values[0]); },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          means.craft.tell("begun " + std::to_string(step.values[0]));
          done(step.values[0] != 0, "nothing to note");
        },
    .fences =
        [](const ProcedureStep& step, const Means& means) {
          means.craft.tell("first " + std::to_string(step.values[0]));
          return std::vector<std::uint16_t>{};
        }};

struct EngineTest : PartsTest {
  PlayedDesk desk;
  ProcedureRunner runner{means_with(desk)};
  std::vector<std::string> ends;

  void start(std::vector<Stage> stages, OnFailure on_failure = OnFailure::Stop) {
    runner.start({std::move(stages), on_failure,
                  [this](const ProcedureEnd& end) { ends.push_back(end.success ? "success" : end.text()); }});
  }
  const std::vector<Stage> two_stages{{to_state(arm, PreOperational), to_state(hand, PreOperational)},
                                      {to_state(arm, SafeOperational)}};
};

TEST_F(EngineTest, AStageIsSentAtOnceTheNextWaitsForItsLastAnswer) {
  start(two_stages);
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 3", "11 SET_STATE 3"));
  EXPECT_EQ(runner.waiting_for(), "ARM: PreOperational, HAND: PreOperational");
  desk.answers[1](true, "");
  EXPECT_EQ(runner.waiting_for(), "ARM: PreOperational");
  EXPECT_EQ(desk.sent.size(), 2u);
  desk.answers[0](true, "");
  EXPECT_EQ(desk.sent.back(), "10 SET_STATE 4");
  EXPECT_TRUE(runner.running());
  desk.answers[2](true, "");
  EXPECT_FALSE(runner.running());
  EXPECT_EQ(runner.waiting_for(), "");
  EXPECT_THAT(ends, ElementsAre("success"));
}

TEST_F(EngineTest, AFailureEndsItWithWhoAndWhy) {
  start(two_stages);
  desk.answers[1](false, "link absent");
  EXPECT_THAT(ends, ElementsAre("HAND PreOperational: link absent"));
  EXPECT_FALSE(runner.running());
  desk.answers[0](true, "");  // too late to matter
  EXPECT_EQ(desk.sent.size(), 2u);
  EXPECT_EQ(ends.size(), 1u);
}

TEST_F(EngineTest, IfToldToItGoesOnAndNamesTheFirstFailureAtTheEnd) {
  start(two_stages, OnFailure::GoOn);
  desk.answers[1](false, "link absent");
  desk.answers[0](false, "another");
  EXPECT_EQ(desk.sent.size(), 3u);
  desk.answers[2](true, "");
  EXPECT_THAT(ends, ElementsAre("HAND PreOperational: link absent"));
}

TEST_F(EngineTest, AnswersMayComeBeforeTheCommandReturns) {
  desk.at_once = true;
  start(two_stages);
  EXPECT_EQ(desk.sent.size(), 3u);
  EXPECT_THAT(ends, ElementsAre("success"));
}

TEST_F(EngineTest, AFailureAtOnceKeepsTheRestOfItsStageFromBeingSent) {
  desk.at_once = false;
  start(two_stages);
  EXPECT_EQ(desk.sent.size(), 1u);
  EXPECT_THAT(ends, ElementsAre("ARM PreOperational: at once"));
}

TEST_F(EngineTest, EmptyStagesAreSkippedAndNothingToDoIsASuccess) {
  start({{}, {to_state(arm, PreOperational)}, {}});
  EXPECT_EQ(desk.sent.size(), 1u);
  desk.answers[0](true, "");
  start({});
  EXPECT_THAT(ends, ElementsAre("success", "success"));
}

TEST_F(EngineTest, ACancelledOneSaysNothingMore) {
  start(two_stages);
  runner.cancel();
  EXPECT_FALSE(runner.running());
  desk.answers[0](true, "");
  desk.answers[1](false, "late");
  EXPECT_EQ(desk.sent.size(), 2u);
  EXPECT_TRUE(ends.empty());
}

TEST_F(EngineTest, AnswersToAReplacedOneDoNotCountForTheNext) {
  start(two_stages);
  start({{to_state(arm, Offline)}});
  desk.answers[0](false, "late");
  desk.answers[1](true, "");
  EXPECT_TRUE(runner.running());
  desk.answers[2](true, "");
  EXPECT_THAT(ends, ElementsAre("success"));
}

TEST_F(EngineTest, AnAnswerGivenTwiceCountsOnce) {
  start(two_stages);
  desk.answers[0](true, "");
  desk.answers[0](true, "");
  EXPECT_EQ(desk.sent.size(), 2u);
}

TEST_F(EngineTest, TheNextMayBeStartedFromTheEndOfThis) {
  runner.start({.stages = {{to_state(arm, PreOperational)}},
                .finished = [&](const ProcedureEnd&) { start({{to_state(arm, SafeOperational)}}); }});
  desk.answers[0](true, "");
  EXPECT_TRUE(runner.running());
  desk.answers[1](true, "");
  EXPECT_THAT(ends, ElementsAre("success"));
}

TEST_F(EngineTest, WhatMayNotWaitIsDoneForAllStepsBeforeTheFirstBegins) {
  start(
      {{ProcedureStep{&note_kind, arm, {1}}}, {to_state(arm, PreOperational)}, {ProcedureStep{&note_kind, arm, {2}}}});
  EXPECT_THAT(story, ElementsAre("first 1", "first 2", "begun 1"));
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 3"));
}

TEST_F(EngineTest, AStepOfAnyKindFailsWithItsOwnText) {
  start({{ProcedureStep{&note_kind, hand, {0}}}, {to_state(arm, PreOperational)}});
  EXPECT_THAT(ends, ElementsAre("HAND note 0: nothing to note"));
  EXPECT_THAT(desk.sent, IsEmpty());
}

TEST_F(EngineTest, WhatAnEngineHasBegunGoesOnWithoutIt) {
  {
    ProcedureRunner gone{means_with(desk)};
    gone.start({.stages = two_stages, .finished = [this](const ProcedureEnd&) { ends.push_back("end"); }});
  }
  while (!desk.answers.empty()) desk.answer(true);
  EXPECT_EQ(desk.sent.size(), 3U);
  EXPECT_THAT(ends, ElementsAre("end"));
}

/// Where a plan takes its subject from what it does, and only there, the actuators do not wait for who is to obey.
TEST_F(EngineTest, AStateOfAPlanFencesItsSubjectAndNobodyElseBeforeItIsSentAndNoOtherStateDoes) {
  start_all(Operational);
  parts.graph.set_up(1, true);
  bool fenced = false;
  desk.on_command = [&] { fenced = guard.fenced(arm); };
  for (int is = 0; is < 10; ++is)
    for (int wanted = 0; wanted < 10; ++wanted)
      for (const char* plan : {"", "test"}) {
        const auto state = static_cast<State>(is), target = static_cast<State>(wanted);
        set(arm, state);
        for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
        ProcedureStep planned = to_state(arm, target);
        planned.occasion.plan = plan;
        start({{planned}});
        const bool to_do = target != SafeOperational || state == Operational;
        const bool stops = *plan != '\0' && target != Operational && to_do;
        EXPECT_EQ(fenced, stops) << to_text(state) << " to " << to_text(target) << " by plan '" << plan << "'";
        EXPECT_EQ(played[arm].permit->go.load() == 0, stops);
        EXPECT_FALSE(guard.fenced(hand)) << "a network is what shut_down_network is for";
      }
  EXPECT_EQ(desk.sent.size(), 200U);
}

TEST_F(EngineTest, AStepThatLetsItsSubjectGoDoesNotTakeTheFenceFromALaterOneOfThePlan) {
  start_all(Operational);
  ProcedureStep up = to_state(arm, Operational), down = to_state(arm, SafeOperational);
  up.occasion.plan = down.occasion.plan = "test";
  start({{up}, {down}});
  EXPECT_TRUE(guard.fenced(arm)) << "of the later step";
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  desk.answer(true);
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 5", "10 SET_STATE 4"));
  EXPECT_TRUE(guard.fenced(arm));
}

}  // namespace
}  // namespace hirosco::supervisor
