// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/reactions.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

constexpr std::uint16_t hot = 2000, burning = 2001;

struct ReactionsTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    descriptor::Event event;
    event.name = "HOT";
    event.id = hot;
    event.severity = Severity::Medium;
    craft.mission.subsystems.front().subsystem.events.push_back(event);
    event.name = "BURNING";
    event.id = burning;
    event.severity = Severity::High;
    craft.mission.subsystems.front().subsystem.events.push_back(event);
    start_all(Operational);
    for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  }
  void plan(std::string event, std::vector<descriptor::PlanStep> steps) {
    descriptor::Plan made;
    made.name = "test";
    made.event = std::move(event);
    made.steps = std::move(steps);
    craft.mission.plans.push_back(made);
  }
  static descriptor::PlanStep to_be(State state) { return {"set_state", {static_cast<std::int64_t>(state)}}; }
  void completed(std::uint16_t apid, std::uint8_t subtype = 7) {
    for (const auto& sent : received(apid)) verify(apid, sent.request, subtype, pus::FailureCode::ExecutionError);
  }
};

TEST_F(ReactionsTest, AnEventOfMediumSeverityMakesItsSubsystemSafeAndNobodyElse) {
  event(arm, hot, Severity::Medium);
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
  EXPECT_THAT(texts(hand), IsEmpty());
  EXPECT_TRUE(was_told("plan default: ARM to SafeOperational because of HOT"));
}

TEST_F(ReactionsTest, WhoIsMadeSafeIsInhibitedAtOnceThoughItNeverObeys) {
  parts.graph.set_up(1, true);
  event(arm, hot, Severity::Medium);
  EXPECT_EQ(played[arm].permit->go.load(), 0U);
  EXPECT_EQ(played[arm].permit->stop.load(), 1U);
  EXPECT_FALSE(guard.fenced(hand));
  wait(WaitingForDisk::limit);
  parts.own_telecommands.watch(clock.now());
  EXPECT_TRUE(was_told("ARM SET_STATE 4: no answer"));
  EXPECT_EQ(played[arm].permit->go.load(), 0U);
  EXPECT_TRUE(guard.fenced(hand)) << "the plan failed, and its network goes down";
}

TEST_F(ReactionsTest, WhoObeyedIsBroughtToOperationalAgainInTheOrdinaryWay) {
  event(arm, hot, Severity::Medium);
  obey(arm);
  EXPECT_TRUE(guard.fenced(arm)) << "until it is let go";
  EXPECT_FALSE(craft.member(arm)->recovery.running());
  parts.own_telecommands.command(arm, "SET_STATE", static_cast<double>(Operational), nullptr);
  parts.telecommands.forward_durable();
  EXPECT_THAT(texts(arm), ElementsAre(to(Operational)));
  EXPECT_FALSE(guard.fenced(arm));
  EXPECT_NE(played[arm].permit->go.load(), 0U);
}

TEST_F(ReactionsTest, WhatWasPermittedBeforeAPlanDoesNotLetGoWhomItHasStopped) {
  const std::uint64_t before = guard.fences(arm);
  event(arm, hot, Severity::Medium);
  obey(arm);
  EXPECT_FALSE(guard.release(arm, before));
}

TEST_F(ReactionsTest, WhoDoesNotActNeedsNotBeMadeSafe) {
  set(arm, SafeOperational);
  event(arm, hot, Severity::Medium);
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_FALSE(was_told("because of HOT"));
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(ReactionsTest, AnEventOfHighSeverityStopsTheNetworkBeforeAnythingIsSent) {
  parts.graph.set_up(1, true);
  event(arm, burning, Severity::High);
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_THAT(texts(arm), ElementsAre(to(ErrorOperational)));
  EXPECT_THAT(texts(hand), ElementsAre(to(ErrorOperational)));
  EXPECT_TRUE(was_told("plan default: network {ARM, HAND} to ErrorOperational and down"));
}

TEST_F(ReactionsTest, EachOfANetworkGoesItsOwnWayDown) {
  parts.graph.set_up(1, true);
  event(arm, burning, Severity::High);
  obey(hand);
  EXPECT_TRUE(was_told("HAND is Offline"));
  EXPECT_FALSE(craft.member(hand)->recovery.running());
  EXPECT_TRUE(craft.member(arm)->recovery.running()) << "it has not answered";
  completed(arm, 8);
  EXPECT_THAT(texts(arm), ElementsAre(to(Offline))) << "whatever became of the first step";
}

TEST_F(ReactionsTest, WhatTheDescriptorCallsSevereIsNotMadeHarmlessByTheMessage) {
  event(arm, burning, Severity::Info);
  EXPECT_TRUE(guard.fenced(arm));
}

TEST_F(ReactionsTest, WhileAPlanRunsOnlySomethingWorseOverridesIt) {
  event(arm, hot, Severity::Medium);
  EXPECT_EQ(texts(arm).size(), 1U);
  event(arm, hot, Severity::Medium);
  EXPECT_THAT(texts(arm), IsEmpty());
  event(arm, burning, Severity::High);
  EXPECT_THAT(texts(arm), ElementsAre(to(ErrorOperational)));
  EXPECT_TRUE(guard.fenced(arm));
}

TEST_F(ReactionsTest, AfterAPlanTheNextEventBeginsItAgain) {
  event(arm, hot, Severity::Medium);
  completed(arm);
  event(arm, hot, Severity::Medium);
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
}

TEST_F(ReactionsTest, NobodyIsCommandedTwiceOnItsWayDownButADeathIsNeverSwallowed) {
  plan("PROCESS_DIED", {{"restart", {1, 60, 0, 0}}, {"shut_down_network"}});
  parts.graph.set_up(1, true);
  event(arm, burning, Severity::High);
  static_cast<void>(texts(hand));
  guard.forget(arm);
  craft.member(arm)->died();
  parts.reactions.react(*craft.member(arm), "PROCESS_DIED", Severity::High);
  EXPECT_THAT(texts(hand), IsEmpty());
  EXPECT_EQ(parts.restarts.take_due(clock.now()), arm);
}

TEST_F(ReactionsTest, APlanThatFailsEscalatesToTheWholeNetwork) {
  parts.graph.set_up(1, true);
  event(arm, hot, Severity::Medium);
  completed(arm, 8);
  EXPECT_TRUE(was_told("plan failed (" + std::string{to_text(pus::FailureCode::ExecutionError)} + "): escalating"));
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_THAT(texts(hand), ElementsAre(to(ErrorOperational)));
}

TEST_F(ReactionsTest, TheStepsOfAPlanAreTakenOneAfterTheOther) {
  plan("HOT", {to_be(ErrorOperational), to_be(PostOperational)});
  event(arm, hot, Severity::Medium);
  auto sent = received(arm);
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].text, to(ErrorOperational));
  verify(arm, sent[0].request, 7);
  EXPECT_TRUE(craft.member(arm)->recovery.running());
  sent = received(arm);
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].text, to(PostOperational));
  verify(arm, sent[0].request, 7);
  EXPECT_FALSE(craft.member(arm)->recovery.running());
}

TEST_F(ReactionsTest, AStopThatIsTheLastStepOfAPlanIsDoneAtOnceAllTheSame) {
  plan("HOT", {to_be(SafeOperational), {"shut_down_network"}});
  event(arm, hot, Severity::Medium);
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
}

TEST_F(ReactionsTest, ARestartAnswersDeathsOnlyAndOfThoseNoMoreThanItsLimit) {
  plan("", {{"restart", {1, 60, 0, 0}}});
  event(arm, burning, Severity::High);
  EXPECT_EQ(parts.restarts.take_due(clock.now()), std::nullopt);
  craft.member(arm)->died();
  parts.reactions.react(*craft.member(arm), "PROCESS_DIED", Severity::High);
  EXPECT_EQ(parts.restarts.take_due(clock.now()), arm);
  parts.reactions.react(*craft.member(arm), "PROCESS_DIED", Severity::High);
  EXPECT_EQ(parts.restarts.take_due(clock.now()), std::nullopt);
  EXPECT_TRUE(was_told("ARM stays down: it died too often"));
}

TEST_F(ReactionsTest, APlanForAnEventOfTheSupervisorItselfConcernsAllThatAct) {
  plan("LOG_STORE", {to_be(SafeOperational)});
  set(hand, SafeOperational);
  parts.own.start(craft.mode_epoch);
  own_step();
  parts.own.announce("LOG_STORE");
  own_step();
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational)));
  EXPECT_THAT(texts(hand), IsEmpty());
  EXPECT_THAT(texts(camera), IsEmpty()) << "the ground link";
  EXPECT_TRUE(was_told("plan test: all subsystems because of LOG_STORE"));
}

TEST_F(ReactionsTest, APlanForAnEventOfTheSupervisorItselfThatFailsEscalatesForWhomItFailed) {
  plan("LOG_STORE", {to_be(SafeOperational)});
  parts.own.start(craft.mode_epoch);
  own_step();
  parts.own.announce("LOG_STORE");
  own_step();
  completed(hand);
  completed(arm, 8);
  EXPECT_TRUE(was_told("plan failed (" + std::string{to_text(pus::FailureCode::ExecutionError)} + "): escalating"));
  EXPECT_THAT(texts(arm), ElementsAre(to(ErrorOperational)));
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_THAT(texts(hand), IsEmpty()) << "it did as it was told";
}

TEST_F(ReactionsTest, GroundIsToldOfEachStateThatAPlanCommands) {
  parts.own.start(craft.mode_epoch);
  own_step();
  event(arm, hot, Severity::Medium);
  own_step();
  EXPECT_TRUE(was_told("RECOVERY_STEP APID=10"));
}

TEST_F(ReactionsTest, NothingIsPlannedWhileTheFlightEnds) {
  craft.shutting_down = true;
  event(arm, burning, Severity::High);
  EXPECT_THAT(texts(arm), IsEmpty());
}

TEST_F(ReactionsTest, AnEventThatCannotBeReadIsCounted) {
  const std::array damaged{std::byte{9}};
  ASSERT_TRUE(played[arm].channel.subsystem_end().send({.kind = MessageKind::Event, .packet = damaged}));
  parts.reception.read(*craft.member(arm));
  EXPECT_EQ(craft.member(arm)->unreadable, 1U);
  EXPECT_THAT(texts(arm), IsEmpty());
}

}  // namespace
}  // namespace hirosco::supervisor
