// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/ground_link_care.hpp"

#include <algorithm>
#include <utility>

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct GroundLinkCareTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    craft.mission.modes.front().commission = {
        {.subsystem = "CAMERA", .configuration = "ONLY", .state = Operational, .at = {}}};
    start_all(Operational);
  }
  /// The supervisor looks every 10 ms.
  void look_for(Duration span) {
    for (const TimePoint end = clock.now() + span; clock.now() < end; wait(10ms)) parts.ground_link.watch(clock.now());
  }
};

TEST_F(GroundLinkCareTest, OneThatHearsTheGroundIsLeftAlone) {
  look_for(5s);
  EXPECT_THAT(texts(camera), IsEmpty());
}

TEST_F(GroundLinkCareTest, AfterASecondInOfflineItIsBroughtBackToWhatItsModeAsksFor) {
  set(camera, Offline);
  look_for(1s);
  EXPECT_THAT(texts(camera), IsEmpty());
  look_for(20ms);
  const auto first = received(camera);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].text, to(PreOperational));
  EXPECT_TRUE(craft.restoring_ground_link);
  set(camera, PreOperational);
  verify(camera, first[0].request, 7);
  EXPECT_THAT(texts(camera), ElementsAre("CONFIGURE 1"));
}

TEST_F(GroundLinkCareTest, WithoutAConfigurationItIsDeafInWhateverState) {
  set(camera, PreOperational, 0);
  look_for(1050ms);
  EXPECT_THAT(texts(camera), ElementsAre("CONFIGURE 1")) << "it is in Pre-Operational already";
}

TEST_F(GroundLinkCareTest, FromErrorOperationalTheWayGoesThroughPostOperational) {
  set(camera, ErrorOperational, 0);
  look_for(1050ms);
  EXPECT_THAT(texts(camera), ElementsAre(to(PostOperational)));
}

TEST_F(GroundLinkCareTest, EachVainAttemptIsFollowedByTwiceThePauseTenSecondsAtMost) {
  set(camera, Offline);
  for (const Duration pause : {1s, 2s, 4s, 8s, 10s, 10s}) {
    look_for(pause - 50ms);
    EXPECT_THAT(texts(camera), IsEmpty()) << seconds(pause);
    look_for(100ms);
    const auto sent = received(camera);
    ASSERT_EQ(sent.size(), 1U) << seconds(pause);
    verify(camera, sent[0].request, 2, pus::FailureCode::WrongState);
    EXPECT_FALSE(craft.restoring_ground_link);
    wait(-50ms);
  }
  EXPECT_TRUE(was_told("the ground link did not come back"));
}

TEST_F(GroundLinkCareTest, NobodyCaresForItDuringTheShutdown) {
  set(camera, Offline);
  craft.shutting_down = true;
  look_for(2s);
  EXPECT_FALSE(craft.restoring_ground_link);
  craft.member(camera)->died();
  look_for(2s);
  EXPECT_FALSE(parts.restarts.is_planned(camera));
}

TEST_F(GroundLinkCareTest, WithLinksDownThatItsConfigurationRequiresItComesBackWithOneThatRequiresNone) {
  auto& subsystem = craft.mission.subsystems[2].subsystem;
  descriptor::Configuration remote;
  remote.name = "REMOTE";
  remote.id = 7;
  descriptor::Requires wanted;
  wanted.name = "HAND_STATE";
  remote.requires_ = {wanted};
  subsystem.configurations.insert(subsystem.configurations.begin(), remote);
  craft.mission.modes.front().commission.front().configuration = "REMOTE";
  set(camera, PreOperational, 0);
  look_for(1050ms);
  EXPECT_THAT(texts(camera), ElementsAre("CONFIGURE 1"));
}

/// Its process ends. The mission has no plan: by default the network of who died goes down, and nobody starts it again.
struct GroundLinkDeathTest : GroundLinkCareTest {
  void dies() {
    ends[played[camera].process] = {.by_signal = true, .value = 9};
    parts.processes.watch(clock.now());
    ends.clear();
    ASSERT_FALSE(craft.member(camera)->alive());
  }
  void watch_for(Duration span) {
    for (const TimePoint end = clock.now() + span; clock.now() < end; wait(10ms)) {
      parts.processes.watch(clock.now());
      parts.ground_link.watch(clock.now());
      parts.waiting.watch(clock.now());
    }
  }
  void plan(std::vector<descriptor::PlanStep> steps) {
    descriptor::Plan made;
    made.name = "died";
    made.event = "PROCESS_DIED";
    made.steps = std::move(steps);
    craft.mission.plans = {made};
  }
  [[nodiscard]] bool alive() { return craft.member(camera)->alive(); }
  /// It does what it is told until nobody tells it anything.
  void obeys() {
    for (int step = 0; step < 20; ++step) {
      parts.telecommands.forward_durable();
      obey(camera);
    }
  }
  static constexpr const char* by_rule = "CAMERA carries the ground link and is started again, which no plan asks for";
};

TEST_F(GroundLinkDeathTest, IsFollowedByAStartThoughNoPlanAsksForIt) {
  dies();
  watch_for(100ms);
  EXPECT_FALSE(alive());
  watch_for(10ms);
  ASSERT_TRUE(alive());
  EXPECT_EQ(std::ranges::count(story, by_rule), 1);
  EXPECT_THAT(texts(camera), ElementsAre(to(PreOperational))) << "it is brought back to what its mode asks for";
}

TEST_F(GroundLinkDeathTest, IsTheOnlyOneThatIsFollowedByAStart) {
  ends[played[hand].process] = {.by_signal = true, .value = 9};
  parts.processes.watch(clock.now());
  watch_for(2s);
  EXPECT_FALSE(craft.member(hand)->alive());
}

TEST_F(GroundLinkDeathTest, AgainAndAgainDoublesThePauseUpToTenSecondsAndKeepsItDownNever) {
  for (const Duration pause : {100ms, 200ms, 400ms, 800ms, 1600ms, 3200ms, 6400ms, 10000ms, 10000ms}) {
    dies();
    watch_for(pause);
    EXPECT_FALSE(alive()) << seconds(pause);
    watch_for(10ms);
    ASSERT_TRUE(alive()) << seconds(pause);
  }
  EXPECT_FALSE(was_told("stays down"));
}

TEST_F(GroundLinkDeathTest, WithAPlanThatRestartsItIsThePlans) {
  plan({{"restart", {1, 60, 1000, 0}}});
  dies();
  watch_for(1s);
  EXPECT_FALSE(alive());
  watch_for(10ms);
  EXPECT_TRUE(alive());
  EXPECT_FALSE(was_told(by_rule));
}

TEST_F(GroundLinkDeathTest, WithAPlanThatHasStillToComeToItsRestartIsThePlans) {
  plan({{"wait_for", {static_cast<std::int64_t>(SafeOperational), arm, 500}}, {"restart", {1, 60, 0, 0}}});
  dies();
  watch_for(300ms);
  EXPECT_FALSE(alive());
  set(arm, SafeOperational);
  watch_for(20ms);
  EXPECT_TRUE(alive());
  EXPECT_FALSE(was_told(by_rule));
}

TEST_F(GroundLinkDeathTest, WithAPlanThatNeverComesToItsRestartIsFollowedByAStartAllTheSame) {
  plan({{"wait_for", {static_cast<std::int64_t>(SafeOperational), arm, 500}}, {"restart", {1, 60, 0, 0}}});
  dies();
  watch_for(700ms);
  EXPECT_TRUE(alive());
  EXPECT_TRUE(was_told(by_rule));
}

TEST_F(GroundLinkDeathTest, DuringAStopOfEverythingBringsItBackAndLetsNobodyElseGo) {
  for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  parts.safe_all.asked();
  dies();
  watch_for(110ms);
  ASSERT_TRUE(alive());
  obeys();
  EXPECT_EQ(craft.member(camera)->state(), Operational);
  EXPECT_TRUE(was_told("the ground link is back"));
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(guard.fenced(hand));
}

TEST_F(GroundLinkDeathTest, DuringAChangeOfModeEndsTheChangeAndBringsItBack) {
  const auto wanted = std::exchange(craft.mission.modes.front().commission, {});
  start_supervisor();
  craft.mission.modes.front().commission = wanted;
  craft.mission.modes[1].commission = {{.subsystem = "HAND", .configuration = "ONLY", .state = Operational, .at = {}}};
  set(hand, SafeOperational);
  ASSERT_EQ(call_own("SET_MODE", 2), "") << "it has begun";
  ASSERT_NE(craft.changing_to, nullptr);
  dies();
  EXPECT_EQ(craft.changing_to, nullptr);
  watch_for(110ms);
  ASSERT_TRUE(alive());
  obeys();
  EXPECT_EQ(craft.member(camera)->state(), Operational);
}

TEST_F(GroundLinkDeathTest, BeforeItsFirstStartWaitsForTheCommissioningToEnd) {
  craft.member(camera)->died();
  craft.member(camera)->was_started = false;
  parts.own.start(craft.mode_epoch);
  parts.commissioning.start([] {});
  ASSERT_TRUE(parts.under_way.running());
  watch_for(1s);
  EXPECT_FALSE(parts.restarts.is_planned(camera)) << "who commissions starts it";
  parts.commissioning.drop();
  watch_for(110ms);
  EXPECT_TRUE(alive());
}

}  // namespace
}  // namespace hirosco::supervisor
