// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/testing/parts_rig.hpp"

/// A member whose control channel is full, of answers to its own flood or of telecommands, and what the supervisor itself says to it.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::Not;
using enum descriptor::State;

struct FullChannel : PartsTest {
  static constexpr std::uint16_t broken = 2000;

  void SetUp() override {
    PartsTest::SetUp();
    start_all(Operational);
    for (const auto& link : craft.mission.links) parts.graph.set_up(link.id, true);
    set(arm, Operational, 2);
  }
  void ask(std::uint16_t apid) { parts.telecommands.take({.packet = ping(apid), .origin = Origin::ground()}); }
  static std::vector<std::byte> ping(std::uint16_t apid) { return telecommand(apid, 17, 1, {}); }
  void fill(std::uint16_t apid) {
    for (std::size_t i = 0; i <= ChannelPair::default_capacity; ++i) ask(apid);
  }
  std::string reads_one(std::uint16_t apid) {
    MessageBuffer buffer;
    const auto found = played[apid].channel.subsystem_end().receive(buffer);
    if (!found || found->flow == Flow::None) return {};
    return telecommand_text(pus::TelecommandView::parse(found->message.packet).value());
  }
  void step() {
    own_step();
    for (Member& member : craft.members) member.beat(1, clock.now());
  }
};

TEST_F(FullChannel, ARecoveryReachesItsMemberAsSoonAsThatReads) {
  fill(hand);
  event(arm, broken, Severity::High);
  EXPECT_TRUE(guard.fenced(hand)) << "that waits for no channel";
  for (int i = 0; i < 10; ++i) step();
  EXPECT_FALSE(was_told("queue full"));
  // Ground goes on asking: each place that becomes free is the recovery's first.
  std::vector<std::string> texts;
  for (std::size_t i = 0; i <= ChannelPair::default_capacity; ++i) {
    texts.push_back(reads_one(hand));
    ask(hand);
  }
  EXPECT_EQ(texts.back(), to(ErrorOperational));
}

TEST_F(FullChannel, OfAMemberThatReadsAgainIsTakenDownWithItsNetwork) {
  fill(hand);
  event(arm, broken, Severity::High);
  for (int i = 0; i < 5; ++i) {
    step();
    obey(hand);
  }
  EXPECT_EQ(craft.member(hand)->state(), Offline);
  EXPECT_TRUE(was_told("HAND is Offline"));
}

TEST_F(FullChannel, WhoStandsAfterAStopIsToldItsStateAsSoonAsItReads) {
  fill(arm);
  parts.safe_all.asked();
  parts.safe_all.follow();
  step();
  EXPECT_FALSE(was_told("queue full"));
  EXPECT_THAT(texts(arm), Not(Contains(to(SafeOperational))));
  step();
  EXPECT_THAT(texts(arm), Contains(to(SafeOperational)));
}

TEST_F(FullChannel, WhatTheSupervisorSaysThatLetsSomebodyMoveIsNotKept) {
  craft.restoring_ground_link = true;
  set(camera, SafeOperational);
  fill(camera);
  parts.own_telecommands.command(camera, "SET_STATE", static_cast<double>(Operational), nullptr);
  EXPECT_TRUE(guard.fenced(camera)) << "it could not be sent";
  received(camera);
  step();
  EXPECT_THAT(texts(camera), Not(Contains(to(Operational))));
}

TEST_F(FullChannel, WhatGroundSaysIsRefusedAsEver) {
  fill(hand);
  parts.telecommands.take({.packet = telecommand(hand, 8, 1, call_data("BRAKE")), .origin = Origin::ground()});
  received(hand);
  step();
  EXPECT_THAT(texts(hand), Not(Contains("BRAKE")));
}

}  // namespace
}  // namespace hirosco::supervisor
