// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/restoration.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "supervisor/supervision/testing/parts_rig.hpp"
#include "supervisor/supervision/testing/played_desk.hpp"

/// HAND was commanded to Operational in its configuration 1; the test answers what is sent. Whole flights:
/// tests/integration.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct RestorationTest : PartsTest {
  PlayedDesk desk;
  CommandedMembers& commanded = parts.commanded;
  Restoration restoration{means_with(desk), parts.own, parts.under_way};
  std::uint16_t count{0};

  void SetUp() override {
    PartsTest::SetUp();
    descriptor::Plan plan;
    plan.name = "back";
    plan.event = "PROCESS_DIED";
    plan.steps = {{"restart", {3, 60, 0, static_cast<std::int64_t>(Operational)}}};
    craft.mission.plans.push_back(plan);
    start_all(Operational);
    set(arm, Operational, 2);
    parts.own.start(craft.mode_epoch);
    own_step();
    was_commanded(hand, 1, Operational);
    story.clear();
  }
  static std::vector<std::byte> state_call(State state) { return call_data("SET_STATE", static_cast<int>(state)); }
  std::uint32_t leaves(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data,
                       const Origin& origin = Origin::supervisor()) {
    std::vector<std::byte> buffer(pus::max_telecommand_octets);
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = apid,
                                                .sequence_count = ++count,
                                                .ack = pus::ack_all,
                                                .service = service,
                                                .subtype = subtype,
                                                .source = supervisor_apid},
                                               data);
    const auto telecommand = pus::TelecommandView::parse(*packet).value();
    commanded.forwarded(apid, telecommand, origin);
    return telecommand.request_id();
  }
  void completes(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data) {
    verify(apid, leaves(apid, service, subtype, data), 7);
  }
  void was_commanded(std::uint16_t apid, int configuration, State state) {
    completes(apid, 8, 1, state_call(PreOperational));
    completes(apid, 8, 1, call_data("CONFIGURE", configuration));
    for (const State each : {SafeOperational, Operational})
      if (each <= state) completes(apid, 8, 1, state_call(each));
  }
  /// Its function SET_LIMITS sets LIMITS.
  void hand_has_limits() {
    auto& subsystem = craft.mission.subsystems[1].subsystem;
    descriptor::Parameter limits;
    limits.field.name = "LIMITS";
    limits.id = 4;
    limits.protection = true;
    subsystem.parameters.push_back(limits);
    auto sets = function("SET_LIMITS", in_states({Operational}));
    sets.unrepeated = {static_cast<std::uint16_t>(subsystem.parameters.size() - 1)};
    subsystem.functions.push_back(sets);
  }
  /// Its plan has answered its death by a restart up to this state.
  void dies(std::uint16_t apid, State most = Operational) {
    parts.resources.release(apid);
    guard.forget(apid);
    craft.member(apid)->died();
    restoration.lost(apid);
    ASSERT_TRUE(parts.restarts.plan(apid, {.limit = 100, .within = 60s, .pause = 1ms, .most = most}, clock.now()));
    restoration.answered(apid);
  }
  void starts(std::uint16_t apid) { ASSERT_TRUE(parts.processes.start(apid)); }
  void begins() {
    dies(hand);
    starts(hand);
    restoration.watch(clock.now());
  }
  void all_obey() {
    while (!desk.answers.empty()) desk.answer(true);
  }
};

TEST_F(RestorationTest, WhoDiedGoesUpByTheStatesToWhatItWasCommandedToBe) {
  begins();
  EXPECT_TRUE(was_told("HAND: back to the commanded state"));
  EXPECT_THAT(desk.sent, ElementsAre("11 SET_STATE 3")) << "the next waits for its answer";
  all_obey();
  EXPECT_THAT(desk.sent, ElementsAre("11 SET_STATE 3", "11 CONFIGURE 1", "11 SET_STATE 4", "11 SET_STATE 5"));
  EXPECT_EQ(desk.counts.back(), guard.fences(hand)) << "whoever is stopped meanwhile is not let go by it";
  EXPECT_TRUE(was_told("HAND: as commanded"));
  own_step();
  EXPECT_TRUE(was_told("SUPERVISOR info RESTORED APID=11"));
  restoration.watch(clock.now());
  EXPECT_EQ(desk.sent.size(), 4U) << "once";
}

TEST_F(RestorationTest, ItGoesNoFurtherThanItsPlanSays) {
  dies(hand, SafeOperational);
  starts(hand);
  restoration.watch(clock.now());
  all_obey();
  EXPECT_THAT(desk.sent, ElementsAre("11 SET_STATE 3", "11 CONFIGURE 1", "11 SET_STATE 4"));
}

TEST_F(RestorationTest, TheSettingsOfBeforeAreSentInPreOperational) {
  completes(hand, 5, 6, std::array{std::byte{1}, std::byte{0}, std::byte{4}});
  begins();
  all_obey();
  EXPECT_THAT(desk.sent,
              ElementsAre("11 SET_STATE 3", "11 CONFIGURE 1", "11 TC[5,6] 0 ms", "11 SET_STATE 4", "11 SET_STATE 5"));
}

TEST_F(RestorationTest, WhomAFunctionHadProtectedDoesNotMoveAgainByItselfAndWhatIsLostIsTold) {
  hand_has_limits();
  completes(hand, 8, 1, call_data("SET_LIMITS"));
  begins();
  all_obey();
  EXPECT_EQ(desk.sent.back(), "11 SET_STATE 4");
  EXPECT_TRUE(was_told("HAND comes back to Safe-Operational only, without what functions had set: LIMITS"));
}

TEST_F(RestorationTest, WhatIsLostIsToldOfWhoWasNotToMoveToo) {
  hand_has_limits();
  completes(hand, 8, 1, state_call(SafeOperational));
  completes(hand, 8, 1, call_data("SET_LIMITS"));
  dies(hand);
  EXPECT_TRUE(was_told("HAND comes back without what functions had set: LIMITS"));
}

TEST_F(RestorationTest, WhoDiesBeforeItHasSaidThatItsLimitsAreSetDoesNotMoveAgainByItself) {
  hand_has_limits();
  leaves(hand, 8, 1, call_data("SET_LIMITS"));
  begins();
  all_obey();
  EXPECT_EQ(desk.sent.back(), "11 SET_STATE 4");
}

TEST_F(RestorationTest, WhoseLimitsAreSetOnItsWayBackAndDiesAgainDoesNotMoveAgainByItself) {
  hand_has_limits();
  begins();
  desk.answer(true);
  completes(hand, 8, 1, call_data("SET_LIMITS"));
  dies(hand);
  desk.answers.clear();
  starts(hand);
  restoration.watch(clock.now());
  all_obey();
  EXPECT_EQ(desk.sent.back(), "11 SET_STATE 4");
}

TEST_F(RestorationTest, WhoseLimitsWereSetWhileItCountedAsHangingDoesNotMoveAgainByItself) {
  hand_has_limits();
  restoration.lost(hand);
  leaves(hand, 8, 1, call_data("SET_LIMITS"));
  begins();
  all_obey();
  EXPECT_EQ(desk.sent.back(), "11 SET_STATE 4");
}

TEST_F(RestorationTest, WhatCanBeSetInOperationalOnlyIsToldAsMissing) {
  descriptor::Parameter too_late;
  too_late.field.name = "LATE";
  too_late.field.type = Type::Uint8;
  too_late.id = 3;
  too_late.writable_states = in_states({Operational});
  craft.mission.subsystems[1].subsystem.parameters.push_back(too_late);
  std::array<std::byte, 6> data{};
  OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{hand, Type::Uint8, 3}.wire());
  completes(hand, 20, 3, data);
  dies(hand);
  EXPECT_TRUE(was_told("HAND comes back without LATE: it is set in Operational only"));
}

// --- a network ------------------------------------------------------------------------------------------------------

TEST_F(RestorationTest, WhoWentDownWithItComesBackWithItAndTheirLinkBeforeAnybodyIsSafe) {
  was_commanded(arm, 2, SafeOperational);
  parts.graph.set_up(1, true);
  dies(hand);
  set(arm, Offline);
  parts.graph.forget(1);
  starts(hand);
  restoration.watch(clock.now());
  all_obey();
  EXPECT_THAT(desk.sent, ElementsAre("10 SET_STATE 3", "11 SET_STATE 3", "10 CONFIGURE 2", "11 CONFIGURE 1", "1 LINK 1",
                                     "10 SET_STATE 4", "11 SET_STATE 4", "11 SET_STATE 5"));
  EXPECT_TRUE(was_told("ARM, HAND: as commanded"));
}

TEST_F(RestorationTest, ALinkToWhoWentOnIsMadeWhereItsConfigurationHasThatSet) {
  parts.graph.set_up(1, true);
  dies(hand);
  parts.graph.forget(1);
  starts(hand);
  restoration.watch(clock.now());
  all_obey();
  EXPECT_THAT(desk.sent, ::testing::Not(Contains("1 LINK 1")));
  descriptor::Provides provided;
  provided.name = "ARM_STATE";
  craft.mission.subsystems[0].subsystem.configurations[0].provides = {provided};
  was_commanded(hand, 1, Operational);
  parts.graph.set_up(1, true);
  dies(hand);
  parts.graph.forget(1);
  starts(hand);
  restoration.watch(clock.now());
  all_obey();
  EXPECT_THAT(desk.sent, Contains("1 LINK 1"));
}

// --- what it waits for ----------------------------------------------------------------------------------------------

TEST_F(RestorationTest, WhoIsNotReadyInItsTimeStaysWhereItIs) {
  dies(hand);
  wait(Restoration::patience);
  restoration.watch(clock.now());
  EXPECT_FALSE(was_told("not brought back"));
  wait(1ms);
  restoration.watch(clock.now());
  EXPECT_TRUE(was_told("HAND not brought back: they were not ready in time"));
  own_step();
  EXPECT_TRUE(was_told("SUPERVISOR medium NOT_RESTORED APID=11"));
  starts(hand);
  restoration.watch(clock.now());
  EXPECT_THAT(desk.sent, IsEmpty());
}

TEST_F(RestorationTest, ANewDeathGivesItAllItsTimeAgain) {
  dies(hand);
  wait(Restoration::patience - 1s);
  dies(hand);
  wait(Restoration::patience);
  restoration.watch(clock.now());
  EXPECT_FALSE(was_told("not brought back"));
}

TEST_F(RestorationTest, NothingIsSentToWhoIsOnItsWayOrInARecoveryOrCannotHear) {
  dies(hand);
  restoration.watch(clock.now());
  EXPECT_THAT(desk.sent, IsEmpty()) << "its process is not there yet";
  starts(hand);
  Member& member = *craft.member(hand);
  for (const State state : {SoftwareInit, HardwareInit, PostOperational, HardwareDeinit, SoftwareDeinit}) {
    set(hand, state, 0);
    restoration.watch(clock.now());
    EXPECT_THAT(desk.sent, IsEmpty()) << to_text(state);
  }
  set(hand, Offline);
  member.recovery.plan_begins(Severity::Low);
  restoration.watch(clock.now());
  EXPECT_THAT(desk.sent, IsEmpty()) << "a recovery";
  member.recovery.started();
  member.closed_at = clock.now();
  restoration.watch(clock.now());
  EXPECT_THAT(desk.sent, IsEmpty()) << "its channel is closed";
  member.closed_at.reset();
  restoration.watch(clock.now());
  EXPECT_THAT(desk.sent, ElementsAre("11 SET_STATE 3"));
}

// --- what counts as commanded ---------------------------------------------------------------------------------------

TEST_F(RestorationTest, WhatWasCommandedBeforeItHungCountsAsLongAsAHangMayLastBeforeTheDeath) {
  for (const Duration beyond : {Duration{0}, Duration{1ms}}) {
    was_commanded(hand, 1, Operational);
    restoration.lost(hand);
    leaves(hand, 8, 1, state_call(PreOperational));
    wait(Restoration::hang_before_death + beyond);
    dies(hand);
    ASSERT_NE(commanded.wanted(hand), nullptr);
    EXPECT_EQ(commanded.wanted(hand)->state(), beyond == Duration{0} ? Operational : PreOperational);
    EXPECT_EQ(restoration.cancel("the next"), Cancelled::Ended);
    starts(hand);
  }
}

TEST_F(RestorationTest, WhoMovedAgainAndDiesIsLookedAtAnew) {
  restoration.lost(hand);
  restoration.recovered(hand);
  leaves(hand, 8, 1, state_call(PreOperational));
  dies(hand);
  ASSERT_NE(commanded.wanted(hand), nullptr);
  EXPECT_EQ(commanded.wanted(hand)->state(), PreOperational);
}

TEST_F(RestorationTest, WhoIsKilledAgainOnItsWayComesBackAllTheSame) {
  begins();
  desk.answer(true);
  desk.sent.clear();
  dies(hand);
  desk.answer(true);
  EXPECT_THAT(desk.sent, IsEmpty()) << "what was begun with the last process is over";
  starts(hand);
  restoration.watch(clock.now());
  all_obey();
  EXPECT_THAT(desk.sent, ElementsAre("11 SET_STATE 3", "11 CONFIGURE 1", "11 SET_STATE 4", "11 SET_STATE 5"));
}

TEST_F(RestorationTest, NobodyIsLookedAtWhileTheFlightEndsOrTheModeChangesOrNoPlanBringsAnybodyBack) {
  craft.shutting_down = true;
  dies(hand);
  EXPECT_THAT(commanded.wanted(), IsEmpty()) << "shutdown";
  craft.shutting_down = false;
  starts(hand);
  was_commanded(hand, 1, Operational);
  const auto plans = std::exchange(craft.mission.plans, {});
  dies(hand);
  EXPECT_THAT(commanded.wanted(), IsEmpty()) << "no plan";
  craft.mission.plans = plans;
  starts(hand);
  was_commanded(hand, 1, Operational);
  parts.commissioning.start([] {});
  ASSERT_TRUE(parts.under_way.running());
  dies(hand);
  EXPECT_THAT(commanded.wanted(), IsEmpty()) << "a change of mode";
}

// --- what ends it ---------------------------------------------------------------------------------------------------

struct EndOfARestoration : RestorationTest {
  /// HAND waits to be brought back, this happens, and what is told then.
  std::string end_by(const std::function<void()>& what) {
    if (!craft.member(hand)->alive()) starts(hand);
    was_commanded(hand, 1, Operational);
    dies(hand);
    story.clear();
    what();
    restoration.watch(clock.now());
    const auto told = std::ranges::find_if(
        story, [](const std::string& line) { return line.find("not brought back") != std::string::npos; });
    return told != story.end() ? *told : std::string{};
  }
};

TEST_F(EndOfARestoration, IsToldWithItsReason) {
  EXPECT_EQ(end_by([] {}), "");
  EXPECT_EQ(end_by([this] { leaves(hand, 8, 1, state_call(Offline), Origin::ground()); }),
            "HAND not brought back: HAND was commanded otherwise");
  EXPECT_EQ(end_by([this] { craft.shutting_down = true; }), "HAND not brought back: shutdown");
  craft.shutting_down = false;
  EXPECT_EQ(end_by([this] { restoration.cancel("somebody says so"); }), "HAND not brought back: somebody says so");
  EXPECT_EQ(end_by([this] { restoration.answered(hand); }), "HAND not brought back: HAND does not come back");
  EXPECT_EQ(end_by([this] { parts.commissioning.start([] {}); }), "HAND not brought back: the mode changes");
  EXPECT_EQ(restoration.cancel("again"), Cancelled::Nothing) << "it is over already";
}

TEST_F(RestorationTest, AStepThatFailsEndsItAndNobodyTriesAgain) {
  begins();
  desk.answer(false, "execution error");
  EXPECT_TRUE(was_told("HAND not brought back: HAND PreOperational: execution error"));
  restoration.watch(clock.now());
  EXPECT_EQ(desk.sent.size(), 1U);
}

TEST_F(RestorationTest, AStopAtWhateverStepEndsItByTheNextStepOrTheNextWatch) {
  for (const bool watched : {false, true})
    for (int steps = 0; steps < 4; ++steps) {
      SCOPED_TRACE(steps);
      was_commanded(hand, 1, Operational);
      begins();
      for (int step = 0; step < steps; ++step) desk.answer(true);
      const std::size_t sent = desk.sent.size();
      guard.fence(hand);
      if (watched) restoration.watch(clock.now());
      desk.answer(true);
      EXPECT_EQ(desk.sent.size(), sent);
      EXPECT_TRUE(was_told("HAND not brought back: HAND was stopped"));
      EXPECT_FALSE(was_told("as commanded"));
      story.clear();
    }
}

TEST_F(RestorationTest, ARecoveryOnItsWayEndsIt) {
  begins();
  craft.member(hand)->recovery.plan_begins(Severity::Low);
  desk.answer(true);
  EXPECT_EQ(desk.sent.size(), 1U);
  EXPECT_TRUE(was_told("HAND not brought back: a recovery of HAND"));
}

TEST_F(RestorationTest, AfterAStopOfEverythingNobodyComesBackToMove) {
  was_commanded(arm, 2, Operational);
  dies(hand);
  restoration.all_stopped("a stop");
  EXPECT_TRUE(was_told("HAND not brought back: a stop"));
  dies(arm);
  ASSERT_NE(commanded.wanted(arm), nullptr);
  EXPECT_EQ(commanded.wanted(arm)->state(), SafeOperational);
  EXPECT_EQ(commanded.wanted(hand), nullptr);
}

}  // namespace
}  // namespace hirosco::supervisor
