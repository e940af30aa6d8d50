// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/subscriptions.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

/// HAND and CAMERA may hear structure 4800 and event 2000 of ARM; CAMERA is the ground link.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;
using enum descriptor::State;
namespace st129 = pus::st129;
using What = st129::Subscribed::What;

constexpr std::uint16_t structure = 4800, cracked = 2000;

struct SubscriptionsTest : PartsTest {
  std::uint16_t count{0};

  void SetUp() override {
    PartsTest::SetUp();
    for (auto& member : craft.mission.subsystems) {
      descriptor::Event event;
      event.name = "CRACKED";
      event.id = cracked;
      event.severity = Severity::Low;
      member.subsystem.events.push_back(event);
      using Kind = descriptor::Thing::Kind;
      if (member.subsystem.id != arm)
        member.subsystem.subscribes = {
            {.subsystem = "ARM",
             .things = {{Kind::Housekeeping, "4800", structure, {}}, {Kind::Event, "CRACKED", cracked, {}}},
             .at = {},
             .apid = arm}};
    }
    start_all(PreOperational);
    parts.own.start(craft.mode_epoch);
    own_step();
  }
  /// A member, or the ground, asks; the last verification of it: "7", "2 18".
  std::string ask(std::uint16_t from, st129::Subtype subtype, st129::Subscribed what,
                  std::optional<std::uint16_t> as = {}) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = supervisor_apid,
                                                .sequence_count = count++,
                                                .ack = pus::ack_completion,
                                                .service = st129::service_type,
                                                .subtype = subtype,
                                                .source = as.value_or(from)},
                                               st129::write_subscribed(what));
    const auto kind = from == camera && as ? MessageKind::GroundTelecommand : MessageKind::Packet;
    EXPECT_TRUE(played[from].channel.subsystem_end().send({.kind = kind, .link = 5, .packet = *packet}));
    last_routed.erase(1);
    parts.reception.read(*craft.member(from));
    own_step();
    const auto& data = last_routed[1];
    if (data.size() < 6) return data.empty() ? "nothing" : "done";
    return "refused " + std::to_string(std::to_integer<int>(data[4]) * 256 + std::to_integer<int>(data[5]));
  }
  std::string hear_structure(std::uint16_t who) {
    return ask(who, st129::subscribe, {arm, What::Structure, structure});
  }
  std::string hear_event(std::uint16_t who) { return ask(who, st129::subscribe, {arm, What::Event, cracked}); }
  /// ARM sends its structure with this value.
  void sample(int value, std::uint16_t of = structure) {
    std::array<std::byte, 3> data{};
    OctetWriter{data}.put(of).put(static_cast<std::uint8_t>(value));
    report(arm, 3, 25, data);
  }
  /// What a member was given of ARM: "3.25 -> 0: 7", "5.2 -> 11".
  std::vector<std::string> given(std::uint16_t apid) {
    std::vector<std::string> found;
    MessageBuffer buffer;
    for (;;) {
      const auto next = played[apid].channel.subsystem_end().receive(buffer);
      if (!next || next->flow == Flow::None) return found;
      const auto heard = pus::TelemetryView::parse(next->message.packet);
      if (!heard || heard->apid() != arm) continue;
      std::string text = std::to_string(heard->service()) + "." + std::to_string(heard->subtype()) + " -> " +
                         std::to_string(heard->destination());
      for (const std::byte octet : heard->source_data().subspan(2))
        text += " " + std::to_string(std::to_integer<int>(octet));
      found.push_back(text);
    }
  }
};

TEST_F(SubscriptionsTest, WhoAskedIsGivenHousekeepingAndEventsAndNobodyElse) {
  EXPECT_EQ(hear_structure(hand), "done");
  EXPECT_EQ(hear_event(hand), "done");
  sample(7);
  sample(8, structure + 1);
  event(arm, cracked, Severity::Low);
  event(hand, cracked, Severity::Low);
  EXPECT_THAT(given(hand), ElementsAre("3.25 -> 0 7", "5.2 -> 11"));
  EXPECT_EQ(ask(hand, st129::unsubscribe, {arm, What::Structure, structure}), "done");
  sample(9);
  event(arm, cracked, Severity::Low);
  EXPECT_THAT(given(hand), ElementsAre("5.2 -> 11"));
}

TEST_F(SubscriptionsTest, AnEventIsHeardWhetherItsReportIsSwitchedOnOrNot) {
  ASSERT_EQ(hear_event(hand), "done");
  for (const auto reported : {pus::Reported::Yes, pus::Reported::No}) {
    std::array<std::byte, 5> buffer{};
    const std::array depth{std::byte{42}};
    const auto octets = pus::write_event_message(
        buffer, {.severity = Severity::Low, .reported = reported, .id = cracked, .auxiliary = depth});
    ASSERT_TRUE(played[arm].channel.subsystem_end().send({.kind = MessageKind::Event, .packet = *octets}));
    parts.reception.read(*craft.member(arm));
    if (reported == pus::Reported::Yes) report(arm, 5, 2, std::array{std::byte{7}, std::byte{208}, std::byte{42}});
  }
  EXPECT_THAT(given(hand), ElementsAre("5.2 -> 11 42", "5.2 -> 11 42")) << "once each";
}

/// Default deny: what no descriptor declares, nobody who declared it under another's id, and neither ground nor supervisor.
TEST_F(SubscriptionsTest, OnlyWhatTheDescriptorDeclaresAndOnlyForOneself) {
  const std::string not_declared = "refused " + std::to_string(static_cast<int>(pus::FailureCode::NotDeclared));
  EXPECT_EQ(ask(hand, st129::subscribe, {arm, What::Structure, structure + 1}), not_declared);
  EXPECT_EQ(ask(hand, st129::subscribe, {arm, What::Event, structure}), not_declared);
  EXPECT_EQ(ask(hand, st129::subscribe, {camera, What::Structure, structure}), not_declared);
  EXPECT_EQ(hear_structure(arm), not_declared);
  EXPECT_EQ(ask(camera, st129::subscribe, {arm, What::Structure, structure}, 7), not_declared) << "the ground";
  const std::string foreign = "refused " + std::to_string(static_cast<int>(pus::FailureCode::ForeignSource));
  EXPECT_EQ(ask(arm, st129::subscribe, {arm, What::Structure, structure}, hand), foreign) << "under HAND's id";
  EXPECT_EQ(ask(hand, st129::subscribe, {arm, What::Structure, structure}, arm), foreign);
  sample(1);
  for (const std::uint16_t each : {arm, hand}) EXPECT_THAT(given(each), IsEmpty()) << each;
}

TEST_F(SubscriptionsTest, SeveralHearAndTheGroundLinkIsGivenNothingTwice) {
  ASSERT_EQ(hear_structure(hand), "done");
  ASSERT_EQ(hear_structure(camera), "done");
  ASSERT_EQ(hear_event(hand), "done");
  ASSERT_EQ(hear_event(camera), "done");
  given(camera);
  sample(7);
  event(arm, cracked, Severity::Low);
  parts.telemetry.serve_ground();
  EXPECT_THAT(given(hand), ElementsAre("3.25 -> 0 7", "5.2 -> 11"));
  EXPECT_THAT(given(camera), ::testing::UnorderedElementsAre("3.25 -> 0 7", "5.2 -> 12"));
}

TEST_F(SubscriptionsTest, TheDeathOfWhoIsHeardEndsNothing) {
  ASSERT_EQ(hear_structure(hand), "done");
  ends[played[arm].process] = {};
  parts.processes.watch(clock.now());
  ends.clear();
  ASSERT_FALSE(craft.member(arm)->alive());
  parts.subscriptions.watch(clock.now());
  ASSERT_TRUE(parts.processes.start(arm));
  set(arm, PreOperational);
  given(hand);
  sample(3);
  EXPECT_THAT(given(hand), ElementsAre("3.25 -> 0 3"));
}

TEST_F(SubscriptionsTest, ItEndsWithTheProcessThatAsked) {
  ASSERT_EQ(hear_structure(hand), "done");
  ends[played[hand].process] = {};
  parts.processes.watch(clock.now());
  ends.clear();
  sample(1);
  parts.subscriptions.watch(clock.now());
  ASSERT_TRUE(parts.processes.start(hand));
  set(hand, PreOperational);
  sample(2);
  EXPECT_THAT(given(hand), IsEmpty()) << "the next process has asked for nothing";
  EXPECT_EQ(hear_structure(hand), "done");
  sample(3);
  EXPECT_THAT(given(hand), ElementsAre("3.25 -> 0 3"));
}

[[nodiscard]] std::vector<std::byte> notes_of(const Subscriptions& subscriptions) {
  std::vector<std::byte> noted(4096);
  OctetWriter writer{noted};
  subscriptions.note(writer);
  EXPECT_TRUE(writer.good());
  noted.resize(writer.size());
  return noted;
}

void goes_on_with(Subscriptions& next, Octets noted) {
  OctetReader reader{noted};
  next.recall(reader);
  EXPECT_TRUE(reader.exhausted());
  next.go_on();
}

TEST_F(SubscriptionsTest, WhoHearsGoesOnHearingFromTheNextSupervisor) {
  ASSERT_EQ(hear_structure(hand), "done");
  ASSERT_EQ(hear_event(hand), "done");
  given(hand);
  Subscriptions next{craft, parts.own};
  goes_on_with(next, notes_of(parts.subscriptions));
  std::array<std::byte, 64> buffer;
  const std::array data{std::byte{0x12}, std::byte{0xC0}, std::byte{7}};  // 4800
  const auto packet = pus::write_telemetry(buffer, {.apid = arm, .service = 3, .subtype = 25}, data);
  next.hear(arm, pus::TelemetryView::parse(*packet).value());
  std::array<std::byte, pus::event_message_head_octets> event{};
  next.hear_event(arm, *pus::write_event_message(event, {.severity = Severity::Low, .id = cracked}));
  next.watch(clock.now());
  EXPECT_THAT(given(hand), ElementsAre("3.25 -> 0 7", "5.2 -> 11"));
}

TEST_F(SubscriptionsTest, WhoDiedWithTheSupervisorAndIsStartedByTheNextHearsNothingItHasNotAskedFor) {
  ASSERT_EQ(hear_event(hand), "done");
  given(hand);
  const auto noted = notes_of(parts.subscriptions);
  ends[played[hand].process] = {};
  parts.processes.watch(clock.now());
  ends.clear();
  Subscriptions next{craft, parts.own};
  goes_on_with(next, noted);
  ASSERT_TRUE(parts.processes.start(hand));
  set(hand, PreOperational);
  std::array<std::byte, pus::event_message_head_octets> event{};
  next.hear_event(arm, *pus::write_event_message(event, {.severity = Severity::Low, .id = cracked}));
  EXPECT_THAT(given(hand), IsEmpty());
}

TEST_F(SubscriptionsTest, ItIsNotedBeforeWhoAskedIsTold) {
  std::vector<std::string> told_at_note;
  craft.remembers = [&] {
    std::vector<std::byte> noted(64);
    OctetWriter writer{noted};
    parts.subscriptions.note(writer);
    told_at_note.push_back(std::to_string(writer.size()) + (last_routed.contains(1) ? " told" : " untold"));
  };
  EXPECT_EQ(hear_structure(hand), "done");
  EXPECT_THAT(told_at_note, AllOf(Not(IsEmpty()), Each("11 untold")));
}

TEST_F(SubscriptionsTest, MoreThanTheJournalHasRoomForIsRefused) {
  std::vector<std::byte> noted(64 << 10);
  OctetWriter writer{noted};
  writer.put(std::uint16_t{1}).put(camera).put(static_cast<std::uint16_t>(Subscriptions::most_heard));
  for (std::size_t i = 0; i < Subscriptions::most_heard; ++i)
    writer.put(Octets{st129::write_subscribed({camera, What::Structure, static_cast<std::uint16_t>(i)})});
  OctetReader reader{writer.written()};
  parts.subscriptions.recall(reader);
  parts.subscriptions.go_on();
  EXPECT_EQ(hear_structure(hand), "refused " + std::to_string(static_cast<int>(pus::FailureCode::QueueFull)));
}

TEST_F(SubscriptionsTest, WhatIsTooMuchInASecondIsLostCountedAndTold) {
  ASSERT_EQ(hear_structure(hand), "done");
  wait(1s);
  for (std::size_t i = 0; i < Subscriptions::most_a_second + 30; ++i) sample(static_cast<int>(i % 100));
  EXPECT_EQ(given(hand).size(), Subscriptions::most_a_second);
  parts.subscriptions.watch(clock.now());
  EXPECT_TRUE(was_told("HAND does not read what it hears: 30 reports lost"));
  own_step();
  EXPECT_TRUE(was_told("HEARD_LOST APID=11 LOST=30"));
  wait(1s);
  sample(5);
  EXPECT_EQ(given(hand).size(), 1U) << "in the next second it hears again";
}

TEST_F(SubscriptionsTest, OneThatDoesNotReadIsWaitedForWithAFew) {
  ASSERT_EQ(hear_structure(hand), "done");
  std::size_t sent = 0;
  // Its channel, and then as many as wait; each second so many as it may have.
  for (int second = 0; second < 40; ++second) {
    wait(1s);
    for (std::size_t i = 0; i < Subscriptions::most_a_second; ++i, ++sent) sample(static_cast<int>(sent % 100));
  }
  parts.subscriptions.watch(clock.now());
  const auto first = given(hand).size();
  parts.subscriptions.watch(clock.now());
  const auto rest = given(hand).size();
  EXPECT_EQ(rest, Deliveries::most_waiting);
  EXPECT_LT(first + rest, sent);
  EXPECT_TRUE(was_told("HAND does not read what it hears: " + std::to_string(sent - first - rest) + " reports lost"));
}

}  // namespace
}  // namespace hirosco::supervisor
