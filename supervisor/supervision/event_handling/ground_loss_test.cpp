// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/ground_loss.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using enum descriptor::State;

constexpr std::uint16_t lost = 201, restored = 202;

/// ARM comes to rest when the ground is lost. CAMERA is the ground link, and a station is connected to it.
struct GroundLossTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    for (const auto& [name, id] : {std::pair{"GROUND_LINK_LOST", lost}, std::pair{"GROUND_LINK_RESTORED", restored}}) {
      descriptor::Event event;
      event.name = name;
      event.id = id;
      event.severity = id == lost ? Severity::Medium : Severity::Info;
      craft.mission.subsystems[2].subsystem.events.push_back(event);
    }
    descriptor::Plan rest;
    rest.name = "rest";
    rest.event = "GROUND_LINK_LOST";
    rest.steps = {{"set_state", {static_cast<std::int64_t>(SafeOperational)}, "ARM"}};
    craft.mission.plans = {rest};
    start_all(Operational);
    ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
    event(camera, restored, Severity::Info);
  }
  /// The supervisor looks every 10 ms.
  void look_for(Duration span) {
    for (const TimePoint end = clock.now() + span; clock.now() < end; wait(10ms)) {
      parts.processes.watch(clock.now());
      parts.ground_link.watch(clock.now());
      parts.ground_loss.watch(clock.now());
    }
  }
  void dies() {
    ends[played[camera].process] = {.by_signal = true, .value = 9};
    parts.processes.watch(clock.now());
    ends.clear();
    parts.ground_loss.watch(clock.now());
  }
  /// It was started again, and hears the ground.
  void comes_back() {
    look_for(120ms);
    ASSERT_TRUE(craft.member(camera)->alive());
    set(camera, Operational);
  }
  void sends_a_telecommand() {
    const auto packet = telecommand(arm, 17, 1, {});
    ASSERT_TRUE(played[camera].channel.subsystem_end().send(
        {.kind = MessageKind::GroundTelecommand, .link = 5, .packet = packet}));
    parts.reception.read(*craft.member(camera));
    static_cast<void>(received(arm));
  }
  void says_state(State state) {
    const std::array entered{static_cast<std::byte>(state)};
    std::array<std::byte, 16> buffer{};
    const auto octets = pus::write_event_message(
        buffer, {.severity = Severity::Info, .id = descriptor::framework_event::state_changed, .auxiliary = entered});
    ASSERT_TRUE(octets);
    ASSERT_TRUE(played[camera].channel.subsystem_end().send({.kind = MessageKind::Event, .packet = *octets}));
    parts.reception.read(*craft.member(camera));
  }
  [[nodiscard]] std::ptrdiff_t reactions() const {
    return std::ranges::count(story, "plan rest: ARM to SafeOperational because of GROUND_LINK_LOST");
  }
};

TEST_F(GroundLossTest, IsToldWhenTheProcessOfTheGroundLinkIsDeadForLongerThanThePatience) {
  craft.mission.plans.push_back({});
  craft.mission.plans.back().name = "slow";
  craft.mission.plans.back().event = "PROCESS_DIED";
  craft.mission.plans.back().steps = {{"restart", {1, 60, 60000, 0}}};
  dies();
  look_for(2s);
  EXPECT_EQ(reactions(), 0);
  look_for(20ms);
  EXPECT_EQ(reactions(), 1);
  EXPECT_TRUE(guard.fenced(arm));
  look_for(10s);
  EXPECT_EQ(reactions(), 1) << "once";
}

TEST_F(GroundLossTest, IsToldWhereTheGroundLinkCameBackAndNobodyCameBackToIt) {
  dies();
  comes_back();
  look_for(1900ms);
  EXPECT_EQ(reactions(), 1);
}

TEST_F(GroundLossTest, IsNoneWhereTheStationConnectsAgainInTime) {
  dies();
  comes_back();
  look_for(1800ms);
  event(camera, restored, Severity::Info);
  look_for(10s);
  EXPECT_EQ(reactions(), 0);
}

TEST_F(GroundLossTest, IsNoneWhereATelecommandComesInTimeWhateverTheGroundLinkSays) {
  dies();
  comes_back();
  look_for(1800ms);
  sends_a_telecommand();
  look_for(10s);
  EXPECT_EQ(reactions(), 0);
}

TEST_F(GroundLossTest, NeedsSomebodyWhoWasThere) {
  event(camera, lost, Severity::Medium);
  obey(arm);
  ASSERT_EQ(reactions(), 1) << "by the ground link's own word";
  set(arm, Operational);
  dies();
  look_for(10s);
  EXPECT_EQ(reactions(), 1) << "it was told already";
  comes_back();
  sends_a_telecommand();
  dies();
  look_for(3s);
  EXPECT_EQ(reactions(), 2) << "somebody was there again";
}

TEST_F(GroundLossTest, IsToldInEachStateInWhichNobodyCanBeConnectedAndInNoOther) {
  for (const State state : {Offline, SoftwareInit, HardwareInit, PreOperational, SafeOperational, Operational,
                            ErrorOperational, PostOperational, HardwareDeinit, SoftwareDeinit}) {
    set(camera, Operational);
    event(camera, restored, Severity::Info);
    set(arm, Operational);
    const auto before = reactions();
    set(camera, state);
    for (const TimePoint end = clock.now() + 3s; clock.now() < end; wait(10ms)) parts.ground_loss.watch(clock.now());
    EXPECT_EQ(reactions() - before, state == Offline || is_transient(state) ? 1 : 0) << to_text(state);
    obey(arm);
  }
}

TEST_F(GroundLossTest, IsToldWhereItWasOfflineForSoShortThatNobodySaw) {
  says_state(Offline);
  look_for(1900ms);
  EXPECT_EQ(reactions(), 0);
  look_for(200ms);
  EXPECT_EQ(reactions(), 1);
}

TEST_F(GroundLossTest, IsToldOfOneWhoseServiceLoopWasFoundToStandStill) {
  parts.ground_loss.stands_still(*craft.member(camera), Guard::service_limit);
  look_for(10ms);
  EXPECT_EQ(reactions(), 1) << "it has heard nobody for longer than the patience already";
}

TEST_F(GroundLossTest, IsNoneOfOneThatMovesAgainUnlessItWasCutOffMeanwhile) {
  Member& link = *craft.member(camera);
  parts.ground_loss.stands_still(link, {});
  look_for(1s);
  parts.ground_loss.moves_again(link);
  look_for(10s);
  EXPECT_EQ(reactions(), 0) << "whoever was connected is so still";
  parts.ground_loss.stands_still(link, {});
  says_state(Offline);
  parts.ground_loss.moves_again(link);
  look_for(3s);
  EXPECT_EQ(reactions(), 1);
}

TEST_F(GroundLossTest, HasNothingToDoWithAnotherMember) {
  parts.ground_loss.stands_still(*craft.member(hand), Guard::service_limit);
  ends[played[hand].process] = {.by_signal = true, .value = 9};
  look_for(3s);
  EXPECT_EQ(reactions(), 0);
}

TEST_F(GroundLossTest, IsNoneOnTheWayDown) {
  craft.shutting_down = true;
  set(camera, Offline);
  look_for(3s);
  EXPECT_EQ(reactions(), 0);
}

TEST_F(GroundLossTest, IsToldByTheNextSupervisorWhereThisOneDiesMeanwhile) {
  set(camera, Offline);
  parts.ground_loss.watch(clock.now());
  std::array<std::byte, 64> notes{};
  OctetWriter writer{notes};
  parts.ground_loss.note(writer);
  GroundLoss next{craft, parts.own, parts.reactions};
  OctetReader reader{writer.written()};
  next.recall(reader);
  ASSERT_TRUE(reader.exhausted());
  set(camera, Operational);
  wait(2s);
  next.watch(clock.now());
  EXPECT_EQ(reactions(), 0);
  wait(10ms);
  next.watch(clock.now());
  EXPECT_EQ(reactions(), 1);
}

TEST_F(GroundLossTest, IsPlannedForAlikeWhomeverThePlanNamesAndWhoeverHasTheEvent) {
  for (const bool has_it : {true, false})
    for (const char* named : {"CAMERA", "SUPERVISOR"}) {
      if (!has_it) craft.mission.subsystems[2].subsystem.events.clear();
      craft.mission.plans.front().subsystem = named;
      set(arm, Operational);
      set(camera, Operational);
      sends_a_telecommand();
      const auto before = reactions();
      set(camera, Offline);
      for (const TimePoint end = clock.now() + 3s; clock.now() < end; wait(10ms)) parts.ground_loss.watch(clock.now());
      EXPECT_EQ(reactions() - before, 1) << named << has_it;
      obey(arm);
    }
}

TEST_F(GroundLossTest, IsAnEventOfTheSupervisorsThatSaysOfWhom) {
  start_supervisor();
  set(camera, Offline);
  parts.ground_loss.watch(clock.now());
  wait(2010ms);
  parts.ground_loss.watch(clock.now());
  for (int step = 0; step < 5; ++step) own_step();
  EXPECT_TRUE(was_told("SUPERVISOR medium GROUND_LINK_LOST APID=12")) << ::testing::PrintToString(story);
}

}  // namespace
}  // namespace hirosco::supervisor
