// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/replies.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

/// One subsystem commands another: HAND's descriptor declares MOVE_TO of ARM.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct RepliesTest : PartsTest {
  std::uint16_t count{0};

  void SetUp() override {
    PartsTest::SetUp();
    for (auto& member : craft.mission.subsystems)
      if (member.subsystem.id == hand)
        member.subsystem.commands = {{.subsystem = "ARM", .functions = {"MOVE_TO", "BRAKE"}, .at = {}, .apid = arm}};
    start_all(Operational);
    for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  }
  struct Words {
    std::uint16_t source{hand};
    std::uint8_t ack{pus::ack_all};
    const char* function{"MOVE_TO"};
    std::uint16_t to{arm};
  };
  /// A member, or the ground by its link, sends a call; what the supervisor says of it is heard.
  std::uint32_t send(std::uint16_t from, MessageKind kind, const Words& words) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = words.to,
                                                .sequence_count = count++,
                                                .ack = words.ack,
                                                .service = 8,
                                                .subtype = 1,
                                                .source = words.source},
                                               call_data(words.function));
    EXPECT_TRUE(played[from].channel.subsystem_end().send({.kind = kind, .link = 5, .packet = *packet}));
    parts.reception.read(*craft.member(from));
    own_step();
    return pus::TelecommandView::parse(*packet)->request_id();
  }
  std::uint32_t ask(const Words& words) { return send(hand, MessageKind::Packet, words); }
  std::uint32_t ask() { return ask(Words{}); }

  struct Heard {
    std::uint16_t from{};
    int service{};
    int subtype{};
    std::vector<int> data{};
    friend bool operator==(const Heard&, const Heard&) = default;
    friend void PrintTo(const Heard& heard, std::ostream* out) {
      *out << heard.from << " TM[" << heard.service << ',' << heard.subtype << ']'
           << ::testing::PrintToString(heard.data);
    }
  };
  /// Reports that a member was given since it was asked last; of service 1 without the request id.
  std::vector<Heard> heard(std::uint16_t apid) {
    std::vector<Heard> found;
    MessageBuffer buffer;
    for (;;) {
      const auto next = played[apid].channel.subsystem_end().receive(buffer);
      if (!next || next->flow == Flow::None) return found;
      const auto report = pus::TelemetryView::parse(next->message.packet);
      if (!report) continue;
      Octets data = report->source_data();
      if (report->service() == 1) data = data.subspan(4);
      Heard one{report->apid(), report->service(), report->subtype()};
      for (const std::byte octet : data) one.data.push_back(std::to_integer<int>(octet));
      found.push_back(one);
    }
  }
  /// The failure codes that went to the ground link under this destination, and the ends that did.
  std::vector<int> told_ground(std::uint16_t destination) {
    std::vector<int> found;
    MessageBuffer buffer;
    parts.telemetry.serve_ground();
    for (;;) {
      const auto next = played[camera].channel.subsystem_end().receive(buffer);
      if (!next || next->flow == Flow::None) return found;
      const auto report = pus::TelemetryView::parse(next->message.packet);
      if (!report || report->service() != 1 || report->destination() != destination) continue;
      OctetReader reader{report->source_data()};
      static_cast<void>(reader.get<std::uint32_t>());
      found.push_back(report->subtype() % 2 == 0 ? reader.get<std::uint16_t>() : -report->subtype());
    }
  }
};

TEST_F(RepliesTest, ReportsGoBackToWhoAskedAndToTheGroundAsEver) {
  const std::uint32_t id = ask();
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO"));
  for (const std::uint8_t subtype : std::array<std::uint8_t, 3>{1, 3, 7}) verify(arm, id, subtype, {}, hand);
  verify(arm, id, 7, {}, hand);
  EXPECT_THAT(heard(hand), ElementsAre(Heard{arm, 1, 1}, Heard{arm, 1, 3}, Heard{arm, 1, 7})) << "the end is one";
  EXPECT_THAT(told_ground(hand), ElementsAre(-1, -3, -7, -7));
}

TEST_F(RepliesTest, WhatIsRefusedComesBackWithItsReason) {
  ask({.function = "DANCE"});
  ask({.function = "MOVE_TO", .to = camera});
  ask({.function = "MOVE_TO", .to = 99});
  set(arm, SafeOperational);
  ask();
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(heard(hand), ElementsAre(Heard{1, 1, 2, {0, 18}}, Heard{1, 1, 2, {0, 18}}, Heard{1, 1, 10, {0, 1}},
                                       Heard{1, 1, 2, {0, 10, 4}}));
  EXPECT_THAT(told_ground(hand), ElementsAre(18, 18, 1, 10));
}

TEST_F(RepliesTest, TheModeBindsASubsystemToo) {
  craft.mode = craft.mission.find_mode("narrow");
  ask();
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO"));
  craft.mission.modes[1].permits.clear();
  ask();
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(heard(hand), ElementsAre(Heard{1, 1, 2, {0, 13, 2}}));
}

TEST_F(RepliesTest, ASourceIdThatIsSomebodyElsesIsRefusedAndReportedToWhoReallySpoke) {
  ask({.source = camera});
  ask({.source = supervisor_apid});
  ask({.source = 0});
  EXPECT_THAT(texts(arm), IsEmpty());
  const auto refused = [](int source) { return Heard{1, 1, 2, {0, 17, 0, source}}; };
  EXPECT_THAT(heard(hand), ElementsAre(refused(camera), refused(1), refused(0)));
  EXPECT_THAT(told_ground(hand), ElementsAre(17, 17, 17));
  for (const std::uint16_t source : {supervisor_apid, arm, hand, camera})
    send(camera, MessageKind::GroundTelecommand, {.source = source});
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(told_ground(0), ElementsAre(17, 17, 17, 17));
  EXPECT_THAT(heard(hand), IsEmpty());
  for (const std::uint16_t source : {std::uint16_t{0}, std::uint16_t{13}, std::uint16_t{0xFFFF}})
    send(camera, MessageKind::GroundTelecommand, {.source = source});
  EXPECT_EQ(texts(arm).size(), 3U) << "all others are the ground's";
}

TEST_F(RepliesTest, TheGroundLinkIsASubsystemWhenItSpeaksForItself) {
  send(camera, MessageKind::Packet, {.source = 0});
  EXPECT_THAT(told_ground(camera), ElementsAre(17));
  send(camera, MessageKind::Packet, {.source = camera});
  EXPECT_THAT(told_ground(camera), ElementsAre(18)) << "once: it has every report anyway";
  EXPECT_THAT(texts(arm), IsEmpty());
}

TEST_F(RepliesTest, NobodyIsSentWhatItHasNotAskedFor) {
  verify(arm, 77, 7, {}, hand);
  report(arm, 20, 2, {}, hand);
  EXPECT_THAT(heard(hand), IsEmpty());
  const std::uint32_t id = ask();
  texts(arm);
  report(camera, 20, 2, {}, hand);
  verify(camera, id, 7, {}, hand);
  verify(arm, id + 1, 7, {}, hand);
  report(arm, 20, 2, {}, 999);
  report(arm, 20, 2, {}, arm);
  EXPECT_THAT(heard(hand), IsEmpty());
  EXPECT_THAT(heard(arm), IsEmpty());
  report(arm, 20, 2, {}, hand);
  EXPECT_THAT(heard(hand), ElementsAre(Heard{arm, 20, 2}));
}

TEST_F(RepliesTest, WhoWasAskedCannotFloodWhoAsksAndTheEndPasses) {
  const std::uint32_t id = ask();
  for (int i = 0; i < 3 * Unanswered::most_reports; ++i) verify(arm, id, i % 2 == 0 ? 5 : 6, {}, hand);
  EXPECT_EQ(heard(hand).size(), Unanswered::most_reports);
  verify(arm, id, 8, pus::FailureCode::Aborted, hand);
  EXPECT_THAT(heard(hand), ElementsAre(Heard{arm, 1, 8, {2, 4}}));
}

TEST_F(RepliesTest, WhoDoesNotReadLosesItsOwnReportsOnlyWhichIsTold) {
  std::uint32_t last = 0;
  // Each a second after the other, refused by the arm: the channel holds 256, Replies as many again.
  for (int i = 0; i < 600; ++i) {
    last = ask();
    verify(arm, last, 4, pus::FailureCode::Aborted, hand);
    texts(arm);
    told_ground(hand);
    wait(1s);
    parts.replies.watch(clock.now());
  }
  EXPECT_TRUE(was_told("HAND does not read what it asked for: 1 reports lost"));
  EXPECT_EQ(heard(hand).size(), ChannelPair::default_capacity);
  parts.replies.watch(clock.now());
  EXPECT_EQ(heard(hand).size(), Replies::most_waiting);
  ask();
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO")) << "and works again when it reads";
}

TEST_F(RepliesTest, WhoWasStartedAnewIsGivenNothingOfItsPredecessors) {
  for (int i = 0; i < 300; ++i) {
    verify(arm, ask(), 4, pus::FailureCode::Aborted, hand);
    texts(arm);
    wait(1s);
  }
  craft.member(hand)->died();
  parts.replies.watch(clock.now());
  craft.member(hand)->started(launch(craft.member(hand)->described()).value());
  parts.replies.watch(clock.now());
  EXPECT_THAT(heard(hand), IsEmpty());
}

TEST_F(RepliesTest, WhoseAddresseeDiesIsToldThatNobodyKnowsTheOutcome) {
  verify(arm, ask(), 1, {}, hand);
  heard(hand);
  parts.telecommands.outcome_unknown(arm);
  own_step();
  EXPECT_THAT(heard(hand), ElementsAre(Heard{1, 1, 8, {2, 6}}));
}

TEST_F(RepliesTest, NoMoreThanSixteenAreUnderWayAndAHundredGoInASecondTheOthersAreRefused) {
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < Requester::most_open; ++i) ids.push_back(ask());
  EXPECT_EQ(texts(arm).size(), Requester::most_open);
  ask();
  EXPECT_THAT(heard(hand), ElementsAre(Heard{1, 1, 2, {0, 11}}));
  for (const std::uint32_t id : ids) verify(arm, id, 7, {}, hand);
  for (std::size_t i = Requester::most_open; i < Requester::most_a_second; ++i) verify(arm, ask(), 7, {}, hand);
  EXPECT_EQ(texts(arm).size(), Requester::most_a_second - Requester::most_open);
  heard(hand);
  ask();
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(heard(hand), ElementsAre(Heard{1, 1, 2, {0, 11}}));
  send(camera, MessageKind::GroundTelecommand, {.source = 0});
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO")) << "the ground has its place";
  wait(1s);
  ask();
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO"));
}

TEST_F(RepliesTest, WhoHasFailedOrIsOnItsWayDownCommandsNobodyButTowardsSafety) {
  const auto refused = ElementsAre(Heard{1, 1, 2, {0, 10}});
  for (const descriptor::State state : {Offline, SoftwareInit, HardwareInit, ErrorOperational, PostOperational}) {
    set(hand, state);
    ask();
    EXPECT_THAT(texts(arm), IsEmpty()) << static_cast<int>(state);
    EXPECT_THAT(heard(hand), refused);
  }
  ask({.function = "BRAKE"});
  EXPECT_THAT(texts(arm), ElementsAre("BRAKE"));
  for (const descriptor::State state : {PreOperational, SafeOperational, Operational}) {
    set(hand, state);
    ask();
    EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO")) << static_cast<int>(state);
  }
  craft.member(hand)->recovery.plan_begins(Severity::Low);
  ask();
  EXPECT_THAT(texts(arm), IsEmpty());
  craft.member(hand)->recovery.plan_ended(Severity::Low);
  ASSERT_TRUE(craft.member(hand)->recovery.goes_down());
  ask();
  EXPECT_THAT(texts(arm), IsEmpty());
}

TEST_F(RepliesTest, WhatIsNotToBeReportedAtItsEndIsRefused) {
  ask({.ack = pus::ack_acceptance});
  ask({.ack = 0});
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(heard(hand), ElementsAre(Heard{1, 1, 2, {0, 9}}, Heard{1, 1, 2, {0, 9}}));
}

}  // namespace
}  // namespace hirosco::supervisor
