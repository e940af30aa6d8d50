// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/testing/adoption_rig.hpp"

/// What a supervisor had begun for others when it died, and what becomes of it under the next one (docs/adr/0190, 0191).
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

/// Telecommands of the ground wait for the disk, and leave (docs/adr/0190).
struct WhatLeavesMeanwhile : AdoptionTest {
  std::shared_ptr<HeldDatabase::Hold> hold = std::make_shared<HeldDatabase::Hold>();
  int lives_for{1000};  ///< so many notes; then it has died
  const int refused = 2, failed = 8;
  const std::pair<int, int> refused_now{refused, static_cast<int>(pus::FailureCode::NotPermittedNow)};
  const std::pair<int, int> unknown{failed, static_cast<int>(pus::FailureCode::OutcomeUnknown)};

  void SetUp() override {
    AdoptionTest::SetUp();
    start_all(Operational);
    log.switch_to(std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>()));
    craft.remembers = [this] {
      if (lives_for-- <= 0) return;
      EXPECT_TRUE(notes.note());
    };
    hold->tries = 1'000'000;
  }
  void ground_says(int times = 1) {
    const auto move = telecommand(arm, 8, 1, call_data("MOVE_TO"));
    for (int time = 0; time < times; ++time) parts.telecommands.take({.packet = move, .origin = Origin::ground()});
    craft.remember();
  }
  /// All that waits is on the disk, and leaves; the supervisor dies behind the last of them.
  std::vector<Received> leaves() {
    hold->tries = 0;
    craft.tell("the disk works");
    lives_for = 1;
    parts.telecommands.forward_durable();
    return received(arm);
  }
};

TEST_F(WhatLeavesMeanwhile, IsRefusedWhereItStillWaited) {
  ground_says();
  hold->tries = 0;
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_THAT(told_by(next), ElementsAre(refused_now));
  EXPECT_THAT(texts(arm), ::testing::Not(::testing::Contains("MOVE_TO")));
}

TEST_F(WhatLeavesMeanwhile, IsNotRefusedWhereItsAddresseeCarriesItOut) {
  ground_says();
  const auto left = leaves();
  ASSERT_EQ(left.size(), 1u);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  says(next, arm, left[0], 1);
  wait(1h);
  next.telecommands.watch(clock.now());
  EXPECT_THAT(told_by(next), IsEmpty()) << "it takes its time";
  const auto under_way = next.unanswered.size();
  says(next, arm, left[0], 7);
  EXPECT_EQ(next.unanswered.size(), under_way - 1);
  EXPECT_THAT(told_by(next), IsEmpty());
}

TEST_F(WhatLeavesMeanwhile, IsToldAsUnknownOnceWhereNobodyTellsOfItHoweverManySupervisorsDie) {
  ground_says();
  const auto left = leaves();
  for (int death = 0; death < 3; ++death) ASSERT_TRUE(go_on().memory.note());
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  for (const Duration after : {Duration{Unanswered::doubt - 1ms}, Duration{1ms}, Duration{1h}}) {
    wait(after);
    next.telecommands.watch(clock.now());
    if (after == 1ms) EXPECT_THAT(told_by(next), ElementsAre(unknown));
    else EXPECT_THAT(told_by(next), IsEmpty()) << after / 1ms;
  }
  says(next, arm, left[0], 7);
  EXPECT_TRUE(was_told("ARM tells the end of a telecommand that was told as unknown"));
}

TEST_F(WhatLeavesMeanwhile, IsNotedBeforeTheFirstOfManyHasLeftAndBehindTheLast) {
  ground_says(20);
  std::vector<std::size_t> left_at_notes;
  craft.remembers = [&] { left_at_notes.push_back(received(arm).size()); };
  static_cast<void>(leaves());
  EXPECT_THAT(left_at_notes, ElementsAre(0u, 20u));
  parts.telecommands.forward_durable();
  EXPECT_EQ(left_at_notes.size(), 2u) << "nothing waits";
}

TEST_F(WhatLeavesMeanwhile, WasGivenToSomebodyWhoIsGone) {
  ground_says();
  EXPECT_EQ(leaves().size(), 1u);
  gone = {arm};
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_THAT(told_by(next), ElementsAre(unknown)) << "at once";
}

TEST_F(AdoptionTest, WhatASubsystemHasAskedForIsAnsweredToItUnderTheNextSupervisor) {
  for (descriptor::Mission* flown : {&craft.mission, &next_mission})
    for (auto& member : flown->subsystems)
      if (member.subsystem.id == hand)
        member.subsystem.commands = {{.subsystem = "ARM", .functions = {"MOVE_TO", "BRAKE"}, .at = {}, .apid = arm}};
  start_all(Operational);
  craft.remembers = [this] { EXPECT_TRUE(notes.note()); };
  std::vector<Received> asked;
  for (const char* name : {"MOVE_TO", "BRAKE"}) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = arm,
                                                .sequence_count = static_cast<std::uint16_t>(asked.size()),
                                                .ack = pus::ack_all,
                                                .service = 8,
                                                .subtype = 1,
                                                .source = hand},
                                               call_data(name));
    ASSERT_TRUE(played[hand].channel.subsystem_end().send({.kind = MessageKind::Packet, .packet = *packet}));
    parts.reception.read(*craft.member(hand));
    for (const Received& each : received(arm)) asked.push_back(each);
  }
  ASSERT_EQ(asked.size(), 2u);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  for (const Received& each : asked) says(next, arm, each, 7);
  std::vector<int> heard;
  MessageBuffer buffer;
  for (;;) {
    const auto found = played[hand].channel.subsystem_end().receive(buffer);
    if (!found || found->flow == Flow::None) break;
    if (const auto report = pus::TelemetryView::parse(found->message.packet)) heard.push_back(report->subtype());
  }
  EXPECT_THAT(heard, ElementsAre(7, 7));
}

/// ARM's task is on its way to HAND, which does not answer yet.
TEST_F(AdoptionTest, ThePlanForOneThatWasDeadAlreadyBeginsAnewHoweverManySupervisorsDie) {
  constexpr const char* plan_begins = "plan arm-died: the task of ARM to HAND because of PROCESS_DIED";
  descriptor::Plan arm_died;
  arm_died.name = "arm-died";
  arm_died.event = "PROCESS_DIED";
  arm_died.subsystem = "ARM";
  arm_died.steps = {{"hand_over", {hand, 1}, {}, {"HAND", "ONLY"}}};
  craft.mission.plans = next_mission.plans = {arm_died};
  start_all(PreOperational);
  parts.own.start(craft.mode_epoch);
  ends[played[arm].process] = {.by_signal = true, .value = 9};
  parts.processes.watch(clock.now());
  ASSERT_TRUE(was_told(plan_begins));
  ASSERT_TRUE(notes.note());
  gone = {arm};
  for (int death = 0; death < 3; ++death) {
    story.clear();
    SupervisorParts& next = go_on();
    ASSERT_TRUE(next.memory.note()) << "it dies before it could end anything, or after it";
    if (death == 1) continue;
    begins_to_hear(next);
    EXPECT_EQ(std::ranges::count(story, plan_begins), 1) << death;
    ASSERT_TRUE(next.memory.note());
  }
}

/// ARM has lost what HAND sends, and was on its way to another configuration when the supervisor died.
struct WhoIsLedElsewhereMeanwhile : AdoptionTest {
  void SetUp() override {
    AdoptionTest::SetUp();
    descriptor::Configuration alone;
    alone.name = "ALONE";
    alone.id = elsewhere;
    alone.power_w = 20;
    craft.mission.subsystems[0].subsystem.configurations.push_back(alone);
    craft.mission.links[1].on_loss = descriptor::OnLoss::Fallback;
    craft.mission.links[1].fallback = "ALONE";
    next_mission = craft.mission;
    start_all(Operational);
    set(arm, Operational, coupled);
    ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
    parts.graph.set_up(2, true);
    parts.own.start(craft.mode_epoch);
    craft.remembers = [this] { EXPECT_TRUE(notes.note()); };
    parts.losses.lost(2);
    ASSERT_TRUE(was_told("ARM has lost HAND_STATE of HAND: fallback"));
    ASSERT_THAT(texts(arm), ElementsAre(to(SafeOperational))) << "and this was noted before";
    story.clear();
  }
  static constexpr std::uint8_t coupled = 2, elsewhere = 3;
  static constexpr const char* told = "ARM was on its way to configuration ALONE when the supervisor died: it ";
};

TEST_F(WhoIsLedElsewhereMeanwhile, ComesToRestThereFromWhereverItIsAndThatIsTold) {
  struct Case {
    State state;
    std::uint8_t configuration;
    const char* first;
  };
  for (const auto& [state, configuration, first] :
       {Case{Operational, coupled, "SET_STATE 4"}, Case{SafeOperational, coupled, "SET_STATE 3"},
        Case{PostOperational, coupled, "SET_STATE 3"}, Case{PreOperational, coupled, "SET_STATE 7"},
        Case{PreOperational, 0, "CONFIGURE 3"}}) {
    story.clear();
    set(arm, state, configuration);
    SupervisorParts& next = go_on();
    begins_to_hear(next);
    EXPECT_TRUE(was_told(std::string{told} + "comes to rest there")) << first;
    EXPECT_THAT(texts(arm), ElementsAre(first)) << "once";
    EXPECT_TRUE(next.losses.leads(arm));
    EXPECT_TRUE(next.craft.guard.fenced(arm));
  }
}

TEST_F(WhoIsLedElsewhereMeanwhile, RestsWhereItHasCome) {
  set(arm, SafeOperational, elsewhere);
  begins_to_hear(go_on());
  EXPECT_TRUE(was_told(std::string{told} + "rests there"));
  EXPECT_THAT(texts(arm), IsEmpty());
}

TEST_F(WhoIsLedElsewhereMeanwhile, IsLedWhenItHasComeOutOfWhatItIsInTheMiddleOf) {
  set(arm, HardwareInit, 0);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  next.losses.watch(clock.now());
  EXPECT_FALSE(was_told(told));
  ASSERT_TRUE(next.memory.note());
  set(arm, PreOperational, 0);
  begins_to_hear(go_on());
  EXPECT_TRUE(was_told(told)) << "by the next one as well";
  story.clear();
  next.losses.watch(clock.now());
  EXPECT_TRUE(was_told(told));
}

TEST_F(WhoIsLedElsewhereMeanwhile, GoesDownFromAnError) {
  set(arm, ErrorOperational, coupled);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_TRUE(was_told("ARM: was on its way to configuration ALONE when the supervisor died"));
  EXPECT_TRUE(next.craft.member(arm)->recovery.going_down());
}

TEST_F(WhoIsLedElsewhereMeanwhile, IsLedNowhereBehindAStop) {
  set(arm, PreOperational, 0);
  SupervisorParts& next = go_on();
  next.losses.all_stopped("a stop");
  EXPECT_TRUE(was_told("ARM does not go on in another configuration: a stop"));
  begins_to_hear(next);
  EXPECT_FALSE(was_told(told));
}

/// Whoever looks on and judges the flight as a whole.
struct WhoLooksOn : AdoptionTest {
  void note(OctetWriter& writer) const override { writer.put(knows); }
  void recall(OctetReader& reader) override { recalled = reader.get<std::uint32_t>(); }
  std::uint32_t knows{0}, recalled{0};
};

TEST_F(WhoLooksOn, IsToldUnderTheNextSupervisorWhatItHadNoted) {
  start_all(SafeOperational);
  knows = 7;
  ASSERT_TRUE(notes.note());
  SupervisorParts& next = go_on();
  EXPECT_EQ(recalled, 7u);
  knows = 8;
  ASSERT_TRUE(next.memory.note());
  static_cast<void>(go_on());
  EXPECT_EQ(recalled, 8u);
}

}  // namespace
}  // namespace hirosco::supervisor
