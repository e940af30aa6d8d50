// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/pus/st05_event/event_message.hpp"
#include "supervisor/supervision/testing/adoption_rig.hpp"

/// Plans that were under way for members that live when the supervisor died (docs/adr/0201).
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

/// ARM and HAND act, joined by their links.
struct PlansOfTheLiving : AdoptionTest {
  static constexpr std::uint16_t hot = 2000;
  static constexpr const char* anew =
      "HAND: plan cool because of HOT begins anew: the supervisor died in the midst of it";
  static constexpr const char* failed = ": the supervisor died in the midst of a plan, which counts as failed";
  const descriptor::PlanStep hand_brakes{"command", {1, 0, 15}, "HAND", {"BRAKE"}};
  static descriptor::PlanStep hand_to(State state) { return {"set_state", {static_cast<std::int64_t>(state)}, "HAND"}; }

  void fly(std::string event, std::vector<descriptor::PlanStep> steps) {
    descriptor::Event told;
    told.name = "HOT";
    told.id = hot;
    told.severity = Severity::Low;
    for (const std::size_t teller : {0U, 1U}) craft.mission.subsystems[teller].subsystem.events.push_back(told);
    descriptor::Plan cool;
    cool.name = "cool";
    cool.event = std::move(event);
    cool.steps = std::move(steps);
    craft.mission.plans = {cool};
    next_mission = craft.mission;
    start_all(Operational);
    for (const std::uint16_t apid : {arm, hand}) {
      ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
      played[apid].vital->seen_epoch = played[apid].permit->epoch.load();
    }
    for (const std::uint8_t link : {std::uint8_t{1}, std::uint8_t{2}}) parts.graph.set_up(link, true);
    parts.own.start(craft.mode_epoch);
  }
  void is_noted() {
    ASSERT_TRUE(notes.note());
    story.clear();
    for (const std::uint16_t apid : {arm, hand}) static_cast<void>(received(apid));
  }
  /// ARM is hot, and what is planned for that is under way when the supervisor dies.
  void is_under_way(std::vector<descriptor::PlanStep> steps) {
    fly("HOT", std::move(steps));
    event(arm, hot, Severity::Low);
    is_noted();
  }
  /// Each that a member is sent under this supervisor is carried out, until nothing more comes; what that was.
  std::vector<std::string> obeys(SupervisorParts& next, std::uint16_t apid) {
    std::vector<std::string> all;
    for (auto sent = received(apid); !sent.empty(); sent = received(apid))
      for (const Received& each : sent) {
        constexpr std::string_view to_state = "SET_STATE ";
        if (each.text.starts_with(to_state))
          set(apid, static_cast<descriptor::State>(std::stoi(each.text.substr(to_state.size()))));
        all.push_back(each.text);
        says(next, apid, each, 7);
        next.telecommands.forward_durable();
      }
    return all;
  }
};

TEST_F(PlansOfTheLiving, BeginAnewAndWhomTheyAddressInTheNetworkActsUntilThen) {
  is_under_way({hand_brakes});
  SupervisorParts& next = go_on();
  for (const std::uint16_t apid : {arm, hand}) EXPECT_FALSE(next.craft.guard.fenced(apid)) << apid;
  EXPECT_THAT(texts(hand), IsEmpty()) << "it cannot command yet";
  begins_to_hear(next);
  EXPECT_THAT(texts(hand), ElementsAre("BRAKE"));
  EXPECT_EQ(std::ranges::count(story, anew), 1);
  EXPECT_FALSE(was_told(failed));
  EXPECT_TRUE(next.craft.member(hand)->recovery.running()) << "nobody else commands it up meanwhile";
  for (const std::uint16_t apid : {arm, hand}) EXPECT_FALSE(next.craft.guard.fenced(apid)) << apid;
}

/// docs/adr/0233
TEST_F(PlansOfTheLiving, AreNotedAsTheyBeginBehindTheirFencesAndBeforeTheirFirstStep) {
  fly("HOT", {hand_to(SafeOperational)});
  static_cast<void>(received(hand));
  std::vector<bool> fenced;
  craft.remembers = [&] {
    fenced.push_back(guard.fenced(hand));
    if (fenced.size() == 1) {
      EXPECT_THAT(texts(hand), IsEmpty());
    }
    EXPECT_TRUE(notes.note());
  };
  event(arm, hot, Severity::Low);
  ASSERT_FALSE(fenced.empty());
  EXPECT_TRUE(fenced.front());
  EXPECT_THAT(texts(hand), ElementsAre("SET_STATE 4"));
  // It dies before the end of its step, and what it was about to say with it.
  craft.remembers = nullptr;
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_EQ(std::ranges::count(story, anew), 1);
  EXPECT_THAT(texts(hand), ElementsAre("SET_STATE 4"));
}

/// docs/adr/0233
TEST_F(PlansOfTheLiving, ThatTakeANetworkDownHaveThatNotedBeforeAnybodyIsSentAnything) {
  fly("HOT", {{"shut_down_network"}});
  for (const std::uint16_t apid : {arm, hand}) static_cast<void>(received(apid));
  std::size_t noted = 0;
  craft.remembers = [&] {
    for (const std::uint16_t apid : {arm, hand}) {
      EXPECT_TRUE(guard.fenced(apid)) << apid;
      EXPECT_THAT(texts(apid), IsEmpty()) << apid;
    }
    ++noted;
    EXPECT_TRUE(notes.note());
  };
  event(arm, hot, Severity::Low);
  EXPECT_EQ(noted, 1U);
  craft.remembers = nullptr;
  for (const std::uint16_t apid : {arm, hand}) static_cast<void>(received(apid));
  story.clear();
  // Before the end of its step it dies.
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_TRUE(was_told(failed));
  for (const std::uint16_t apid : {arm, hand}) {
    EXPECT_TRUE(next.craft.guard.fenced(apid)) << apid;
    EXPECT_THAT(obeys(next, apid), Contains("SET_STATE 0")) << apid;
  }
}

TEST_F(PlansOfTheLiving, BeginAnewOnceHoweverManySupervisorsDieBeforeTheyCouldCommand) {
  is_under_way({hand_brakes});
  for (int death = 0; death < 3; ++death) ASSERT_TRUE(go_on().memory.note());
  EXPECT_FALSE(was_told(anew));
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_EQ(std::ranges::count(story, anew), 1);
  EXPECT_THAT(texts(hand), ElementsAre("BRAKE"));
}

TEST_F(PlansOfTheLiving, OverWhichASecondSupervisorDiesCountAsFailedAndTheNetworkIsStoppedAndGoesDown) {
  is_under_way({hand_brakes});
  SupervisorParts& second = go_on();
  begins_to_hear(second);
  ASSERT_TRUE(second.memory.note());
  story.clear();
  SupervisorParts& third = go_on();
  for (const std::uint16_t apid : {arm, hand}) EXPECT_TRUE(third.craft.guard.fenced(apid)) << apid;
  begins_to_hear(third);
  EXPECT_TRUE(was_told("HAND" + std::string{failed}));
  EXPECT_FALSE(was_told(anew));
  for (const std::uint16_t apid : {arm, hand}) EXPECT_TRUE(third.craft.member(apid)->recovery.going_down()) << apid;
}

/// In the very step in which they begin anew, behind which it would be noted.
TEST_F(PlansOfTheLiving, ByWhichASecondSupervisorDiesAtOnceDoNotBeginAThirdTime) {
  is_under_way({hand_brakes});
  begins_to_hear(go_on());
  ASSERT_THAT(texts(hand), ElementsAre("BRAKE"));
  story.clear();
  SupervisorParts& third = go_on();
  for (const std::uint16_t apid : {arm, hand}) EXPECT_TRUE(third.craft.guard.fenced(apid)) << apid;
  begins_to_hear(third);
  EXPECT_TRUE(was_told("HAND" + std::string{failed}));
  EXPECT_FALSE(was_told(anew));
}

TEST_F(PlansOfTheLiving, HaveNothingLeftToDoForWhoHasComeWhereTheyLeadItAndStopNobodyElse) {
  is_under_way({{"set_state", {static_cast<std::int64_t>(SafeOperational)}}});
  set(arm, SafeOperational);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_TRUE(was_told("ARM: plan cool because of HOT has nothing left to do"));
  EXPECT_FALSE(was_told(failed));
  for (const std::uint16_t apid : {arm, hand}) EXPECT_THAT(texts(apid), IsEmpty()) << apid;
  EXPECT_TRUE(next.craft.guard.fenced(arm));
  EXPECT_FALSE(next.craft.guard.fenced(hand));
}

TEST_F(PlansOfTheLiving, CountAsFailedForWhoHasComeElsewhereThanTheyLeadIt) {
  is_under_way({{"set_state", {static_cast<std::int64_t>(SafeOperational)}}});
  set(arm, ErrorOperational);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_TRUE(was_told("ARM" + std::string{failed}));
  for (const std::uint16_t apid : {arm, hand}) {
    EXPECT_TRUE(next.craft.guard.fenced(apid)) << apid;
    EXPECT_TRUE(next.craft.member(apid)->recovery.going_down()) << apid;
  }
}

/// It would refuse, and the plan fail.
TEST_F(PlansOfTheLiving, CommandNobodyToWhereItHasComeAndGoOnFromThere) {
  is_under_way({{"set_state", {static_cast<std::int64_t>(ErrorOperational)}},
                {"set_state", {static_cast<std::int64_t>(PostOperational)}}});
  set(arm, ErrorOperational);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_THAT(texts(arm), ElementsAre(to(PostOperational)));
  EXPECT_TRUE(next.craft.guard.fenced(arm));
  EXPECT_FALSE(next.craft.guard.fenced(hand));
}

/// BRAKE is refused in each state but Operational, and the plan would fail.
TEST_F(PlansOfTheLiving, CallNothingThatWhoHasComeWhereALaterStepLeadsItRefusesThere) {
  is_under_way({hand_brakes, hand_to(SafeOperational)});
  set(hand, SafeOperational);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_TRUE(was_told("HAND: plan cool because of HOT has nothing left to do"));
  EXPECT_FALSE(was_told(failed));
  for (const std::uint16_t apid : {arm, hand}) EXPECT_THAT(texts(apid), IsEmpty()) << apid;
  EXPECT_TRUE(next.craft.guard.fenced(hand));
  EXPECT_FALSE(next.craft.guard.fenced(arm));
}

TEST_F(PlansOfTheLiving, GoOnBehindTheStepThatLeadsToWhereItsSubjectHasCome) {
  is_under_way({hand_brakes, hand_to(ErrorOperational), hand_to(PostOperational), hand_brakes});
  set(hand, PostOperational);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_THAT(texts(hand), ElementsAre("BRAKE")) << "the last step, whatever that one says";
}

TEST_F(PlansOfTheLiving, CallOnceMoreWhatIsPermittedWhereItsSubjectHasCome) {
  auto& brake = craft.mission.subsystems[1].subsystem.functions[1];
  ASSERT_EQ(brake.name, "BRAKE");
  brake.states = in_states({SafeOperational, Operational});
  is_under_way({hand_brakes, hand_to(SafeOperational)});
  set(hand, SafeOperational);
  begins_to_hear(go_on());
  EXPECT_THAT(texts(hand), ElementsAre("BRAKE")) << "whether it was called is not known";
}

TEST_F(PlansOfTheLiving, CallWhatIsRefusedWhereNoStepOfTheirsHasLedTheirSubject) {
  is_under_way({hand_brakes});
  set(hand, SafeOperational);
  begins_to_hear(go_on());
  EXPECT_THAT(texts(hand), ElementsAre("BRAKE")) << "it has not been done, and the plan fails";
}

/// HAND is to brake when a plan of its own has failed, and each supervisor dies that has it do so.
struct PlansForFailure : PlansOfTheLiving {
  static constexpr const char* failure_anew = "HAND: plan last because of RECOVERY_FAILED begins anew";
  void SetUp() override {
    PlansOfTheLiving::SetUp();
    fly("HOT", {hand_brakes});
    descriptor::Plan last;
    last.name = "last";
    last.event = "RECOVERY_FAILED";
    last.steps = {hand_brakes};
    craft.mission.plans.push_back(last);
    next_mission = craft.mission;
    event(arm, hot, Severity::Low);
    is_noted();
  }
  /// In the very step in which it begins what was under way, or behind what it notes of that.
  enum class Dies { AtOnce, Later };
  /// The next one, with what it says and what HAND is sent.
  SupervisorParts& next_that(Dies when) {
    story.clear();
    for (const std::uint16_t apid : {arm, hand}) static_cast<void>(received(apid));
    SupervisorParts& next = go_on();
    begins_to_hear(next);
    if (when == Dies::Later) {
      EXPECT_TRUE(next.memory.note());
    }
    return next;
  }
  void begins_no_third_time(Dies when) {
    next_that(when);
    EXPECT_TRUE(was_told(anew));
    next_that(when);
    EXPECT_TRUE(was_told("HAND" + std::string{failed}));
    EXPECT_THAT(texts(hand), ElementsAre("BRAKE"));
    next_that(when);
    EXPECT_TRUE(was_told(failure_anew));
    EXPECT_THAT(texts(hand), ElementsAre("BRAKE"));
    for (int death = 0; death < 3; ++death) {
      SupervisorParts& next = next_that(when);
      EXPECT_TRUE(was_told("HAND" + std::string{failed})) << death;
      EXPECT_FALSE(was_told("begins anew")) << death;
      EXPECT_THAT(texts(hand), ::testing::Not(Contains("BRAKE"))) << death;
      for (const std::uint16_t apid : {arm, hand}) {
        EXPECT_TRUE(next.craft.guard.fenced(apid)) << apid;
        EXPECT_TRUE(next.craft.member(apid)->recovery.going_down()) << apid;
      }
    }
  }
};

TEST_F(PlansForFailure, OverWhichTwoSupervisorsDieBeginNoThirdTimeAndTheNetworkGoesDown) {
  begins_no_third_time(Dies::Later);
}

TEST_F(PlansForFailure, ByWhichTwoSupervisorsDieAtOnceBeginNoThirdTimeEither) { begins_no_third_time(Dies::AtOnce); }

/// By the loss of a link, say, which is no plan: that gives way with its next step.
TEST_F(PlansOfTheLiving, DoNotBeginAnewForWhomSomebodyElseHasTakenDownMeanwhile) {
  is_under_way({hand_brakes});
  ASSERT_TRUE(craft.member(hand)->recovery.goes_down());
  is_noted();
  SupervisorParts& next = go_on();
  for (const std::uint16_t apid : {arm, hand}) EXPECT_TRUE(next.craft.guard.fenced(apid)) << apid;
  begins_to_hear(next);
  EXPECT_FALSE(was_told("begins anew"));
  EXPECT_TRUE(was_told("HAND" + std::string{failed}));
  EXPECT_TRUE(next.craft.member(hand)->recovery.going_down());
}

TEST_F(PlansOfTheLiving, LeaveWhomTheyStopStoppedAndNobodyElse) {
  is_under_way({{"set_state", {static_cast<std::int64_t>(SafeOperational)}}});
  SupervisorParts& next = go_on();
  EXPECT_TRUE(next.craft.guard.fenced(arm));
  EXPECT_FALSE(next.craft.guard.fenced(hand));
  begins_to_hear(next);
  EXPECT_THAT(texts(arm), ElementsAre(to(SafeOperational))) << "once";
  EXPECT_THAT(texts(hand), IsEmpty());
  EXPECT_TRUE(next.craft.guard.fenced(arm));
  EXPECT_FALSE(next.craft.guard.fenced(hand));
}

/// HAND was let go for the task of ARM and does not act yet.
TEST_F(PlansOfTheLiving, GiveATaskToOneOfItsNetworkWhereverTheDeathLeftThat) {
  fly("HOT", {{"hand_over", {hand, 1}, {}, {"HAND", "ONLY"}}});
  set(hand, SafeOperational);
  event(arm, hot, Severity::Low);
  ASSERT_TRUE(was_told("plan cool: the task of ARM to HAND because of HOT"));
  is_noted();
  SupervisorParts& next = go_on();
  EXPECT_TRUE(next.craft.guard.fenced(arm));
  EXPECT_EQ(against(next, hand), "") << "the fence of the succession is no stop";
  begins_to_hear(next);
  EXPECT_THAT(texts(hand), IsEmpty()) << "before its giver has stopped";
  EXPECT_THAT(obeys(next, arm), ElementsAre(to(SafeOperational)));
  EXPECT_THAT(obeys(next, hand), ElementsAre(to(PreOperational), "CONFIGURE 1", to(SafeOperational), to(Operational)));
  EXPECT_TRUE(next.craft.guard.fenced(arm));
  EXPECT_FALSE(next.craft.guard.fenced(hand));
  EXPECT_TRUE(was_told("the task of ARM is with HAND"));
}

TEST_F(PlansOfTheLiving, ByWhichANetworkGoesDownBeginNothingAnewAndAllOfItGoesDownAsEver) {
  is_under_way({{"shut_down_network"}});
  SupervisorParts& next = go_on();
  for (const std::uint16_t apid : {arm, hand}) EXPECT_TRUE(next.craft.guard.fenced(apid)) << apid;
  begins_to_hear(next);
  EXPECT_FALSE(was_told("begins anew"));
  EXPECT_TRUE(was_told("ARM" + std::string{failed}));
  for (const std::uint16_t apid : {arm, hand}) EXPECT_TRUE(next.craft.member(apid)->recovery.going_down()) << apid;
}

/// Its giver goes down with its network, in which another one stands before it in the mission.
TEST_F(PlansOfTheLiving, GiveATaskOnBehindTheWayDownOfItsNetwork) {
  fly("HOT", {{"shut_down_network"}, {"hand_over", {camera, 1}, {}, {"CAMERA", "ONLY"}}});
  event(hand, hot, Severity::Low);
  constexpr const char* task = "plan cool: the task of HAND to CAMERA because of HOT";
  ASSERT_TRUE(was_told(task));
  is_noted();
  SupervisorParts& next = go_on();
  for (const std::uint16_t apid : {arm, hand}) EXPECT_TRUE(next.craft.guard.fenced(apid)) << apid;
  EXPECT_FALSE(was_told(task));
  begins_to_hear(next);
  EXPECT_TRUE(was_told(task));
  EXPECT_FALSE(was_told(failed)) << "whoever goes down does so already";
  for (const std::uint16_t apid : {arm, hand}) {
    EXPECT_TRUE(next.craft.guard.fenced(apid)) << apid;
    EXPECT_TRUE(next.craft.member(apid)->recovery.going_down()) << apid;
  }
}

TEST_F(PlansOfTheLiving, WhichNobodyFindsAnyMoreCountAsFailedAndStopTheNetwork) {
  is_under_way({hand_brakes});
  next_mission.plans.clear();
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_TRUE(was_told("HAND" + std::string{failed}));
  for (const std::uint16_t apid : {arm, hand}) EXPECT_TRUE(next.craft.guard.fenced(apid)) << apid;
}

TEST_F(PlansOfTheLiving, DoNotBeginAnewBehindAStopOfEverything) {
  is_under_way({hand_brakes});
  parts.safe_all.asked();
  is_noted();
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_FALSE(was_told("begins anew"));
  EXPECT_THAT(texts(hand), ::testing::Not(Contains("BRAKE")));
  for (const std::uint16_t apid : {arm, hand}) EXPECT_TRUE(next.craft.guard.fenced(apid)) << apid;
}

TEST_F(PlansOfTheLiving, ForAnEventOfTheSupervisorItselfBeginAnewForAllThatAct) {
  fly("JOURNAL_FULL", {{"command", {1, 0, 15}, {}, {"BRAKE"}}});
  const auto* full = craft.mission.supervisor.find_event("JOURNAL_FULL");
  ASSERT_NE(full, nullptr);
  std::array<std::byte, pus::event_message_head_octets> buffer{};
  const auto message = pus::write_event_message(buffer, {.severity = full->severity, .id = full->id});
  ASSERT_TRUE(message);
  ASSERT_TRUE(parts.reactions.take_event(supervisor_apid, *message));
  for (const std::uint16_t apid : {arm, hand}) ASSERT_THAT(texts(apid), ElementsAre("BRAKE"));
  is_noted();
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  for (const std::uint16_t apid : {arm, hand}) EXPECT_THAT(texts(apid), ElementsAre("BRAKE"));
  for (const char* name : {"ARM", "HAND"})
    EXPECT_TRUE(was_told(std::string{name} + ": plan cool because of JOURNAL_FULL begins anew"));
}

/// ARM is dead, and its plan has HAND brake; that was under way.
TEST_F(PlansOfTheLiving, WhoseEventWasADeathBeginAnewForTheOneThatLives) {
  fly("PROCESS_DIED", {hand_brakes});
  ends[played[arm].process] = {.by_signal = true, .value = 9};
  parts.processes.watch(clock.now());
  ASSERT_THAT(texts(hand), ElementsAre("BRAKE"));
  is_noted();
  gone = {arm};
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_THAT(texts(hand), ElementsAre("BRAKE"));
  EXPECT_TRUE(was_told("HAND: plan cool because of PROCESS_DIED begins anew"));
  EXPECT_FALSE(was_told("ARM died")) << "that was told, and nothing is to be done about it";
}

}  // namespace
}  // namespace hirosco::supervisor
