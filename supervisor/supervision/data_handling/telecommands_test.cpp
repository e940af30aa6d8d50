// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/telecommands.hpp"

#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using pus::FailureCode;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using enum descriptor::State;

/// The log's database is held by somebody else until the test lets go of it.
struct TelecommandsTest : PartsTest {
  std::shared_ptr<HeldDatabase::Hold> hold = std::make_shared<HeldDatabase::Hold>();
  std::shared_ptr<MemoryDatabase> stored = std::make_shared<MemoryDatabase>();
  const std::vector<std::byte> move = telecommand(arm, 8, 1, call_data("MOVE_TO"));

  void SetUp() override {
    PartsTest::SetUp();
    start_all(Operational);
    log.switch_to(std::make_unique<HeldDatabase>(hold, stored));
  }
  void hold_disk() { hold->tries = 1'000'000; }
  /// All that waited is written with the next record.
  void let_go() {
    hold->tries = 0;
    craft.tell("the disk works");
    parts.telecommands.forward_durable();
  }
  void take(const std::vector<std::byte>& packet, Origin origin = Origin::ground()) {
    parts.telecommands.take({.packet = packet, .origin = origin});
  }
  /// Why telecommands were refused, in the words of the log.
  std::vector<std::string> refusals() {
    std::vector<std::string> found;
    for (const LogRecord& record : all_of(*stored))
      if (record.kind == LogKind::TelecommandRefused) found.emplace_back(record.note.view());
    return found;
  }
  /// What the log says of a telecommand, in its order.
  std::vector<LogKind> records_of(const std::vector<std::byte>& packet) {
    std::vector<LogKind> found;
    for (const LogRecord& record : all_of(*stored))
      if (record.packet == packet) found.push_back(record.kind);
    return found;
  }
  /// What the supervisor has said of telecommands, "SERVICE.SUBTYPE" in its order.
  std::vector<std::string> said() {
    static_cast<void>(parts.own.step(clock.now()));
    std::vector<std::string> types;
    MessageBuffer buffer;
    for (;;) {
      const auto next = parts.own.channel().receive(buffer);
      if (!next || next->flow == Flow::None) return types;
      if (next->message.kind != MessageKind::Packet) continue;
      const auto report = pus::TelemetryView::parse(next->message.packet);
      if (report && (report->service() == 1 || report->service() == pus::st129::service_type))
        types.push_back(std::to_string(report->service()) + "." + std::to_string(report->subtype()));
    }
  }
  static std::string words(FailureCode code) { return std::string{to_text(code)}; }
};

TEST_F(TelecommandsTest, OneThatIsPermittedLeavesWhenItIsOnTheDiskAndNotBefore) {
  hold_disk();
  take(move);
  parts.telecommands.forward_durable();
  EXPECT_THAT(texts(arm), IsEmpty());
  let_go();
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO"));
  EXPECT_FALSE(parts.telecommands.waiting_since());
  EXPECT_THAT(refusals(), IsEmpty());
}

TEST_F(TelecommandsTest, OneTowardsSafetyWaitsForNoDisk) {
  hold_disk();
  take(move);
  take(telecommand(arm, 8, 1, call_data("BRAKE")));
  EXPECT_THAT(texts(arm), ElementsAre("BRAKE"));
  let_go();
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO"));
}

TEST_F(TelecommandsTest, OneThatIsNotOnTheDiskInItsTimeIsRefusedAndNeverSent) {
  hold_disk();
  take(move);
  wait(WaitingForDisk::limit - 1ms);
  parts.telecommands.watch(clock.now());
  EXPECT_TRUE(parts.telecommands.waiting_since());
  wait(1ms);
  parts.telecommands.watch(clock.now());
  EXPECT_FALSE(parts.telecommands.waiting_since());
  let_go();
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::QueueFull)));
}

TEST_F(TelecommandsTest, WhatWasPermittedBeforeAFenceIsVoidAfterIt) {
  hold_disk();
  take(move);
  take(telecommand(hand, 8, 1, call_data("MOVE_TO")));
  guard.fence(arm);
  let_go();
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(texts(hand), ElementsAre("MOVE_TO"));
  craft.tell("and its refusal is written");
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::NotPermittedNow)));
}

TEST_F(TelecommandsTest, AtTheEndAllThatWaitAreRefused) {
  hold_disk();
  for (int i = 0; i < 3; ++i) take(move);
  parts.telecommands.refuse_waiting();
  let_go();
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(refusals(), ::testing::AllOf(SizeIs(3), Each(words(FailureCode::NotPermittedNow))));
}

TEST_F(TelecommandsTest, NoMoreWaitThanThereIsRoomFor) {
  hold_disk();
  for (std::size_t i = 0; i <= WaitingForDisk::most; ++i) take(move);
  hold->tries = 0;
  craft.tell("the disk works");
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::QueueFull)));
}

TEST_F(TelecommandsTest, OneWhoseAddresseeDoesNotReadIsRefused) {
  for (std::size_t i = 0; i < ChannelPair::default_capacity; ++i) take(move);
  EXPECT_THAT(refusals(), IsEmpty());
  take(move);
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::QueueFull)));
}

TEST_F(TelecommandsTest, OneTowardsSafetyThatDoesNotLeaveIsReceivedAndThenRefusedAndHasNoOtherEnd) {
  const auto brake = telecommand(arm, 8, 1, call_data("BRAKE"));
  take(brake);
  EXPECT_THAT(records_of(brake), ElementsAre(LogKind::TelecommandForwarded, LogKind::TelecommandReceived))
      << "one that leaves does so before it is logged";
  for (std::size_t i = 1; i < ChannelPair::default_capacity; ++i) take(move);
  const auto stop = telecommand(arm, 8, 1, call_data("SET_STATE", static_cast<int>(SafeOperational)));
  take(stop);
  EXPECT_THAT(records_of(stop), ElementsAre(LogKind::TelecommandReceived, LogKind::TelecommandRefused));
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::QueueFull)));
}

TEST_F(TelecommandsTest, OneTowardsSafetyThatNobodyIsThereToReadIsToldToGroundBeforeItsRefusal) {
  static_cast<void>(said());
  played[hand].channel.close_subsystem_end();
  const auto brake = telecommand(hand, 8, 1, call_data("BRAKE"));
  take(brake);
  EXPECT_THAT(records_of(brake), ElementsAre(LogKind::TelecommandReceived, LogKind::TelecommandRefused));
  EXPECT_THAT(said(), ElementsAre("129.3", "1.2"));
}

TEST_F(TelecommandsTest, OneWhoseEndCouldNotBeToldIsRefusedButWhatProtectsLeaves) {
  const auto view = pus::TelecommandView::parse(move);
  ASSERT_TRUE(view);
  while (!parts.unanswered.full()) parts.unanswered.forwarded(hand, *view, clock.now());
  take(move);
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::QueueFull)));
  take(telecommand(arm, 8, 1, call_data("BRAKE")));
  EXPECT_THAT(texts(arm), ElementsAre("BRAKE"));
  static_cast<void>(parts.unanswered.take(hand));
  take(move);
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO"));
}

TEST_F(TelecommandsTest, OfDamagedPacketsTenInASecondAreReportedTheOthersAreCounted) {
  auto damaged = move;
  damaged.back() ^= std::byte{1};
  for (int i = 0; i < 15; ++i) take(damaged);
  EXPECT_THAT(refusals(), ::testing::AllOf(SizeIs(10), Each(words(FailureCode::ErrorControl))));
  EXPECT_EQ(parts.traffic.rejections()[static_cast<std::size_t>(FailureCode::ErrorControl)], 5U);
  wait(1s);
  take(damaged);
  EXPECT_THAT(refusals(), SizeIs(11));
  EXPECT_EQ(parts.traffic.counts.telecommands, 16U);
}

TEST_F(TelecommandsTest, ASourceIdOfSomebodyOnBoardIsRefusedFromGroundWithTheClientThatClaimedIt) {
  std::vector<std::byte> claims(pus::max_telecommand_octets);
  const auto packet = pus::write_telecommand(
      claims, {.apid = arm, .ack = pus::ack_all, .service = 17, .subtype = 1, .source = hand}, {});
  claims.resize(packet.value().size());
  take(claims, Origin::ground(3));
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::ForeignSource) + ", client 3"));
}

TEST_F(TelecommandsTest, AStopIsCarriedOutAndReportedToWhoSaidItUnderWhateverSourceId) {
  struct Ear final : Hearer {
    void hear(std::uint16_t, const pus::TelemetryView& heard) override {
      if (heard.service() == 1) reports.emplace_back(heard.subtype(), heard.destination());
    }
    std::vector<std::pair<int, int>> reports;
  };
  const auto stop_by = [&](std::uint16_t source) {
    std::vector<std::byte> octets(pus::max_telecommand_octets);
    const auto packet = pus::write_telecommand(
        octets, {.apid = supervisor_apid, .ack = pus::ack_all, .service = 8, .subtype = 1, .source = source},
        call_data("SAFE_ALL"));
    octets.resize(packet.value().size());
    return octets;
  };
  set(arm, Operational, 2);
  for (const Origin& origin : {Origin::ground(3), Origin::subsystem(hand)})
    for (const std::uint16_t source : {supervisor_apid, arm, std::uint16_t{99}}) {
      if (origin.owns(source, craft.mission)) continue;
      ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
      take(stop_by(source), origin);
      EXPECT_TRUE(guard.fenced(arm)) << source;
      // Who was told to stop has.
      for (auto& [apid, member] : played) member.vital->cycling = 0;
      for (int step = 0; step < 2; ++step, wait(10ms)) static_cast<void>(guard.step(clock.now()));
      parts.safe_all.follow();
      Ear ear;
      Telemetry listening{craft, parts.own, parts.traffic, parts.ground_route, {&ear}};
      static_cast<void>(parts.own.step(clock.now()));
      MessageBuffer buffer;
      for (;;) {
        const auto next = parts.own.channel().receive(buffer);
        if (!next || next->flow == Flow::None) break;
        if (next->message.kind == MessageKind::Packet)
          static_cast<void>(listening.take(supervisor_apid, next->message.packet));
      }
      for (const int subtype : {1, 3, 7})
        EXPECT_THAT(ear.reports, ::testing::Contains(std::pair{subtype, int{origin.apid()}})) << source;
      EXPECT_TRUE(was_told("under the source id " + std::to_string(source)));
    }
  EXPECT_THAT(refusals(), IsEmpty());
}

TEST_F(TelecommandsTest, WhoIsNotOnBoardCannotBeAddressed) {
  take(telecommand(99, 17, 1, {}));
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::UnknownApid)));
}

/// A telecommand that lets ARM move, and what stands between.
struct ReleaseTest : TelecommandsTest {
  const std::vector<std::byte> go = telecommand(arm, 8, 1, call_data("SET_STATE", static_cast<int>(Operational)));

  void SetUp() override {
    TelecommandsTest::SetUp();
    for (const auto& link : craft.mission.links) parts.graph.set_up(link.id, true);
    set(arm, SafeOperational, 2);
  }
  [[nodiscard]] bool may_move() {
    const PermitPage& page = *played[arm].permit;
    return page.permits(page.epoch.load());
  }
};

TEST_F(ReleaseTest, OneThatCouldNotBeSentLeavesNoPermissionToAnOlderOneThatWasNotRead) {
  take(go);
  EXPECT_TRUE(may_move());
  const auto ping = telecommand(arm, 17, 1, {});
  for (std::size_t i = 1; i < ChannelPair::default_capacity; ++i) take(ping);
  guard.stop_all();
  played[arm].vital->cycling = 0;
  for (int step = 0; step < 2; ++step, wait(10ms)) static_cast<void>(guard.step(clock.now()));
  EXPECT_FALSE(may_move());
  EXPECT_THAT(refusals(), IsEmpty());
  take(go);
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::QueueFull)));
  EXPECT_FALSE(may_move());
  EXPECT_TRUE(guard.fenced(arm));
}

TEST_F(ReleaseTest, WhoseLinkIsGoneWhenItsTelecommandIsOnTheDiskIsNotLetGo) {
  hold_disk();
  take(go);
  parts.graph.let_go(2, hand);
  let_go();
  EXPECT_FALSE(may_move());
  EXPECT_THAT(texts(arm), IsEmpty());
  craft.tell("and its refusal is written");
  ASSERT_EQ(refusals().size(), 1u);
  EXPECT_THAT(refusals()[0], ::testing::StartsWith(words(FailureCode::LinkAbsent)));
}

TEST_F(ReleaseTest, WhoLeftTheStateThatItWasPermittedInIsNotLetGo) {
  hold_disk();
  take(go);
  set(arm, PreOperational, 2);
  let_go();
  EXPECT_FALSE(may_move());
}

TEST_F(ReleaseTest, WhoClosedItsChannelIsNotLetGo) {
  played[arm].channel.close_subsystem_end();
  parts.reception.read(*craft.member(arm));
  take(go);
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::WrongState)));
  EXPECT_FALSE(may_move());
}

TEST_F(ReleaseTest, NothingBeginsToMoveAfterShutdownNeitherWhatWaitedForTheDiskNorWhatComesThen) {
  hold_disk();
  take(go);
  parts.shutdown.request();
  take(go);
  let_go();
  EXPECT_FALSE(may_move());
  EXPECT_THAT(texts(arm), ::testing::Not(::testing::Contains("SET_STATE 5")));
  craft.tell("and the refusals are written");
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::NotPermittedNow), words(FailureCode::NotPermittedNow)));
}

TEST_F(ReleaseTest, ShutdownTakesThePermissionOfWhoActsBeforeItObeys) {
  take(go);
  EXPECT_TRUE(may_move());
  parts.shutdown.request();
  EXPECT_FALSE(may_move());
}

TEST_F(TelecommandsTest, WhatProtectsIsNotRefusedForRequestsWhoseEndNobodyTold) {
  auto& others = craft.mission.subsystems;
  auto& asking = *std::ranges::find(others, hand, [](const auto& member) { return member.subsystem.id; });
  descriptor::Commands commands;
  commands.subsystem = "ARM";
  commands.apid = arm;
  commands.functions = {"MOVE_TO", "BRAKE"};
  asking.subsystem.commands = {commands};
  std::uint16_t count = 0;
  const auto ask = [&](std::string_view function) {
    std::vector<std::byte> octets(pus::max_telecommand_octets);
    const auto data = call_data(function);
    const auto packet = pus::write_telecommand(
        octets,
        {.apid = arm, .sequence_count = count++, .ack = pus::ack_all, .service = 8, .subtype = 1, .source = hand},
        data);
    octets.resize(packet.value().size());
    take(octets, Origin::subsystem(hand));
  };
  for (std::size_t i = 0; i < Requester::most_open; ++i) ask("MOVE_TO");
  ask("MOVE_TO");
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::QueueFull)));
  ask("BRAKE");
  EXPECT_THAT(texts(arm), ::testing::Contains("BRAKE"));
  wait(request_patience);
  ask("MOVE_TO");
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO")) << "HAND has given up the others, and so has the supervisor";
}

}  // namespace
}  // namespace hirosco::supervisor
