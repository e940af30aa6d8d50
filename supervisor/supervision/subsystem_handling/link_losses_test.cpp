// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/link_losses.hpp"

#include <algorithm>

#include "supervisor/supervision/testing/parts_rig.hpp"
#include "supervisor/supervision/testing/played_desk.hpp"

/// Link 2 carries HAND_STATE from HAND to ARM, which acts in COUPLED and could do without it in ALONE; the test answers
/// what is sent. Of link 1 the mission says nothing. Whole flights: tests/integration.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using descriptor::OnLoss;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct LinkLossesTest : PartsTest {
  static constexpr std::uint8_t into_hand = 1, into_arm = 2;  // links
  static constexpr std::uint8_t alone = 1, coupled = 2;  // configurations
  static constexpr Duration held_for = 700ms;

  static descriptor::Mission mission_that_says(OnLoss on_loss) {
    auto made = parts_mission();
    made.links[1].on_loss = on_loss;
    made.links[1].hold = held_for;
    made.links[1].fallback = "ALONE";
    descriptor::Configuration without;
    without.name = "ALONE";
    without.id = alone;
    made.subsystems[0].subsystem.configurations.push_back(without);
    return made;
  }
  explicit LinkLossesTest(OnLoss on_loss) : PartsTest{mission_that_says(on_loss)} {}
  PlayedDesk desk;
  LinkLosses losses{means_with(desk), parts.own};

  void SetUp() override {
    PartsTest::SetUp();
    start_all(Operational);
    set(arm, Operational, coupled);
    parts.graph.set_up(into_arm, true);
    ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
    parts.own.start(craft.mode_epoch);
    own_step();
    story.clear();
  }
  void producer_dies() { parts.graph.forget(into_arm); }
  /// ARM's cycle, on its page. Nobody can look at the link itself here, as at one by UDP, or one that another supervisor has made.
  void judges(LinkJudgement judgement, std::uint8_t of_link = into_arm) {
    played[arm].vital->incoming[0].link = of_link;
    played[arm].vital->judged[0] = judgement;
  }
  [[nodiscard]] std::ptrdiff_t times_told() const {
    return std::ranges::count_if(story, [](const std::string& line) { return line.starts_with("ARM has lost "); });
  }
};

// --- hold -----------------------------------------------------------------------------------------------------------

struct WhatIsHeldOver : LinkLossesTest {
  WhatIsHeldOver() : LinkLossesTest{OnLoss::Hold} {}
};

TEST_F(WhatIsHeldOver, IsToldOnceToThePeopleAndToTheGround) {
  losses.lost(into_arm);
  losses.lost(into_arm);
  EXPECT_THAT(story, ElementsAre("ARM has lost HAND_STATE of HAND: hold"));
  own_step();
  EXPECT_TRUE(was_told("SUPERVISOR low LINK_LOST LINK=2 APID=10"));
}

TEST_F(WhatIsHeldOver, GoesOnForItsTimeAndThenDownWithItsOwnNetwork) {
  producer_dies();
  losses.lost(into_arm);
  wait(held_for - 1ms);
  losses.watch(clock.now());
  EXPECT_THAT(desk.sent, IsEmpty());
  EXPECT_FALSE(guard.fenced(arm));
  wait(1ms);
  losses.watch(clock.now());
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_FALSE(guard.fenced(hand));
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 6"));
  EXPECT_TRUE(was_told("ARM: HAND_STATE did not come back in time"));
  EXPECT_TRUE(was_told("plan on loss of link 2: network {ARM} to ErrorOperational and down"));
  losses.watch(clock.now());
  EXPECT_EQ(times_told(), 1) << "who is on its way down needs no word";
}

TEST_F(WhatIsHeldOver, TakesNobodyDownWhoDoesWithoutItByThen) {
  producer_dies();
  losses.lost(into_arm);
  set(arm, Operational, alone);
  wait(held_for);
  losses.watch(clock.now());
  EXPECT_THAT(desk.sent, IsEmpty());
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(WhatIsHeldOver, IsMissedHoweverItWentButOnlyByWhoActsWithIt) {
  producer_dies();
  set(arm, SafeOperational, coupled);
  losses.watch(clock.now());
  set(arm, Operational, alone);
  losses.watch(clock.now());
  EXPECT_THAT(story, IsEmpty());
  set(arm, Operational, coupled);
  losses.watch(clock.now());
  EXPECT_EQ(times_told(), 1);
}

TEST_F(WhatIsHeldOver, IsNoMatterOfWhoGoesDownAnywayNorIsALinkOfWhichTheMissionSaysNothing) {
  losses.lost(into_hand);
  craft.member(arm)->recovery.plan_begins(Severity::Low);
  losses.lost(into_arm);
  craft.member(arm)->recovery.started();
  craft.shutting_down = true;
  losses.lost(into_arm);
  craft.shutting_down = false;
  craft.member(arm)->died();
  losses.lost(into_arm);
  EXPECT_THAT(story, IsEmpty());
}

TEST_F(WhatIsHeldOver, IsAnsweredWhenItsConsumerTellsOfItAndNoOtherEventIs) {
  EXPECT_EQ(losses.answered_link(arm, "HAND_STATE_STALE"), into_arm);
  EXPECT_THAT(story, IsEmpty()) << "asked, not answered";
  EXPECT_FALSE(losses.answers(arm, "HAND_STATE"));
  EXPECT_FALSE(losses.answers(arm, "OTHER_STALE"));
  EXPECT_FALSE(losses.answers(hand, "HAND_STATE_STALE")) << "it makes that set";
  EXPECT_FALSE(losses.answers(hand, "ARM_STATE_STALE")) << "a plan answers that";
  EXPECT_THAT(story, IsEmpty());
  EXPECT_TRUE(losses.answers(arm, "HAND_STATE_STALE"));
  EXPECT_EQ(times_told(), 1);
}

TEST_F(WhatIsHeldOver, IsBackWhenItsConsumerHasItAgainWhateverSamplesTravelBy) {
  for (std::ptrdiff_t loss = 1; loss <= 3; ++loss) {
    judges(link_stale);
    EXPECT_TRUE(losses.answers(arm, "HAND_STATE_STALE"));
    EXPECT_EQ(times_told(), loss);
    wait(100ms);
    losses.watch(clock.now());
    judges(link_valid);
    losses.watch(clock.now());
    wait(held_for);
    losses.watch(clock.now());
  }
  EXPECT_THAT(desk.sent, IsEmpty());
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(WhatIsHeldOver, IsNotBackWithALinkThatIsUpAndOfWhichItsConsumerSaysNothing) {
  for (const auto& [judgement, of_link] :
       {std::pair{link_not_judged, into_arm}, std::pair{link_stale, into_arm}, std::pair{link_valid, into_hand}}) {
    losses.lost(into_arm);
    judges(judgement, of_link);
    wait(held_for);
    losses.watch(clock.now());
    EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 6", "11 SET_STATE 6")) << judgement << ": who joins them is up";
    desk.sent.clear();
    for (const std::uint16_t apid : {arm, hand}) craft.member(apid)->recovery.started();
  }
}

TEST_F(WhatIsHeldOver, IsNotBackFromWhoIsOnItsWayDownAndNotOldYet) {
  ASSERT_TRUE(craft.member(hand)->recovery.goes_down());
  losses.lost(into_arm);
  judges(link_valid);
  losses.watch(clock.now());
  judges(link_stale);
  wait(held_for);
  losses.watch(clock.now());
  EXPECT_EQ(times_told(), 1) << "one loss";
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 6"));
}

TEST_F(WhatIsHeldOver, IsMissedWhereItIsOldThoughNobodyHeardTheEvent) {
  judges(link_stale);
  guard.fence(arm);
  losses.watch(clock.now());
  EXPECT_THAT(story, IsEmpty()) << "it was stopped";
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  losses.watch(clock.now());
  losses.watch(clock.now());
  EXPECT_EQ(times_told(), 1);
}

// --- ignore ---------------------------------------------------------------------------------------------------------

struct WhatIsIgnored : LinkLossesTest {
  WhatIsIgnored() : LinkLossesTest{OnLoss::Ignore} {}
};

TEST_F(WhatIsIgnored, IsToldOnceAndTakesNobodyDownHoweverLongItLasts) {
  producer_dies();
  for (int hour = 0; hour < 3; ++hour) {
    losses.watch(clock.now());
    wait(1h);
  }
  EXPECT_THAT(story, ElementsAre("ARM has lost HAND_STATE of HAND: ignore"));
  EXPECT_THAT(desk.sent, IsEmpty());
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(WhatIsIgnored, IsToldAgainWhenItWasBackAndIsLostAgain) {
  for (std::ptrdiff_t loss = 1; loss <= 3; ++loss) {
    judges(link_stale);
    losses.watch(clock.now());
    losses.watch(clock.now());
    EXPECT_EQ(times_told(), loss);
    judges(link_valid);
    losses.watch(clock.now());
  }
}

// --- fallback -------------------------------------------------------------------------------------------------------

struct WhoFallsBack : LinkLossesTest {
  WhoFallsBack() : LinkLossesTest{OnLoss::Fallback} {}
  /// Again, as if nobody had stopped it.
  void falls_back() {
    desk.sent.clear();
    desk.answers.clear();
    craft.member(arm)->fences_when_free = guard.fences(arm);
    losses.lost(into_arm);
    ASSERT_EQ(desk.sent.size(), 1U);
  }
  void all_obey() {
    while (!desk.answers.empty()) desk.answer(true);
  }
};

TEST_F(WhoFallsBack, IsStoppedAtOnceAndGoesOnInTheOtherConfiguration) {
  losses.lost(into_arm);
  losses.lost(into_arm);
  EXPECT_TRUE(guard.fenced(arm)) << "before it obeys";
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 4"));
  EXPECT_EQ(times_told(), 1);
  all_obey();
  EXPECT_THAT(desk.sent,
              ElementsAre("10 SET_STATE 4", "10 SET_STATE 3", "10 CONFIGURE 1", "10 SET_STATE 4", "10 SET_STATE 5"));
  EXPECT_EQ(desk.counts.back(), guard.fences(arm)) << "whoever is stopped meanwhile is not let go by it";
  EXPECT_TRUE(was_told("ARM goes on in configuration ALONE"));
}

TEST_F(WhoFallsBack, AndWasStoppedBeforeMovesNothing) {
  guard.fence(arm);
  losses.lost(into_arm);
  all_obey();
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 4", "10 SET_STATE 3", "10 CONFIGURE 1", "10 SET_STATE 4"));
}

TEST_F(WhoFallsBack, AndDoesNotActOrIsThereAlreadyIsLeftAlone) {
  set(arm, PreOperational, coupled);
  losses.lost(into_arm);
  set(arm, Operational, alone);
  losses.lost(into_arm);
  EXPECT_THAT(desk.sent, IsEmpty());
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(WhoFallsBack, IsEndedByAStopAtWhateverStep) {
  for (int steps = 0; steps < 4; ++steps) {
    SCOPED_TRACE(steps);
    falls_back();
    for (int step = 0; step < steps; ++step) desk.answer(true);
    const std::size_t sent = desk.sent.size();
    guard.fence(arm);
    desk.answer(true);
    EXPECT_EQ(desk.sent.size(), sent);
    losses.watch(clock.now());
  }
  EXPECT_FALSE(was_told("goes on in configuration"));
}

TEST_F(WhoFallsBack, AndIsStoppedInItsLastStepIsNotToldAsGoingOn) {
  falls_back();
  for (int step = 0; step < 4; ++step) desk.answer(true);
  ASSERT_EQ(desk.sent.back(), "10 SET_STATE 5");
  guard.fence(arm);
  desk.answer(true);
  EXPECT_TRUE(was_told("ARM was stopped in configuration ALONE"));
  EXPECT_FALSE(was_told("goes on in configuration"));
}

TEST_F(WhoFallsBack, FallsBackAgainAtOnceWhereItLosesItsSetAgain) {
  falls_back();
  all_obey();
  const auto told = times_told();
  set(arm, Operational, coupled);
  falls_back();
  EXPECT_EQ(times_told(), told + 1);
}

TEST_F(WhoFallsBack, IsEndedByAChangeOfModeAndByARecovery) {
  falls_back();
  craft.changing_to = &craft.mission.modes[1];
  desk.answer(true);
  EXPECT_EQ(desk.sent.size(), 1U);
  craft.changing_to = nullptr;
  losses.watch(clock.now());
  falls_back();
  craft.member(arm)->recovery.plan_begins(Severity::Low);
  desk.answer(true);
  EXPECT_EQ(desk.sent.size(), 1U);
}

/// Its own fences would pass for a stop by somebody else after the change, and it would not go on acting.
TEST_F(WhoFallsBack, DoesSoAfterAChangeOfModeAndGoesOnActingWhateverIsLostMeanwhile) {
  for (const bool silent : {false, true}) {
    SCOPED_TRACE(silent ? "its producer says nothing" : "its producer is gone");
    desk.sent.clear();
    desk.answers.clear();
    story.clear();
    set(arm, Operational, coupled);
    parts.graph.set_up(into_arm, silent);
    judges(silent ? link_stale : link_not_judged);
    static_cast<void>(guard.release(arm, guard.fences(arm)));
    craft.member(arm)->fences_when_free = guard.fences(arm);
    craft.changing_to = &craft.mission.modes[1];
    for (int step = 0; step < 5; ++step) {
      losses.watch(clock.now());
      EXPECT_TRUE(losses.answers(arm, "HAND_STATE_STALE")) << "no plan begins, either";
    }
    EXPECT_THAT(story, IsEmpty());
    EXPECT_EQ(guard.fences(arm), craft.member(arm)->fences_when_free);
    EXPECT_THAT(desk.sent, IsEmpty());
    craft.changing_to = nullptr;
    losses.watch(clock.now());
    EXPECT_EQ(times_told(), 1);
    all_obey();
    EXPECT_THAT(desk.sent,
                ElementsAre("10 SET_STATE 4", "10 SET_STATE 3", "10 CONFIGURE 1", "10 SET_STATE 4", "10 SET_STATE 5"));
  }
}

TEST_F(WhoFallsBack, AndCannotGoesDown) {
  producer_dies();
  losses.lost(into_arm);
  desk.answer(false, "execution error");
  EXPECT_TRUE(was_told("ARM: ARM SafeOperational: execution error"));
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 4", "10 SET_STATE 6"));
}

TEST_F(WhoFallsBack, IsLeftInTheMiddleByAStopOfEverythingWhichIsTold) {
  EXPECT_EQ(losses.cancel("nobody does"), Cancelled::Nothing) << "nothing to end";
  falls_back();
  EXPECT_EQ(losses.cancel("plan p"), Cancelled::Ended);
  EXPECT_TRUE(was_told("ARM does not go on in another configuration: plan p"));
  desk.answer(true);
  EXPECT_EQ(desk.sent.size(), 1U);
  EXPECT_EQ(losses.cancel("again"), Cancelled::Nothing);
  falls_back();
  losses.all_stopped("a stop");
  EXPECT_TRUE(was_told("ARM does not go on in another configuration: a stop"));
}

}  // namespace
}  // namespace hirosco::supervisor
