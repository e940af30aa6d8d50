// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/telecommands.hpp"

#include "supervisor/platform/test_databases.hpp"
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

TEST_F(TelecommandsTest, WhoIsNotOnBoardCannotBeAddressed) {
  take(telecommand(99, 17, 1, {}));
  EXPECT_THAT(refusals(), ElementsAre(words(FailureCode::UnknownApid)));
}

}  // namespace
}  // namespace hirosco::supervisor
