// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/pages/page_words.hpp"

#include <gtest/gtest.h>

#include <array>
#include <optional>

#include "hirosco/subsystem/author/states.hpp"
#include "hirosco/subsystem/pages/stream_subsystem_port.hpp"

namespace hirosco {
namespace {

/// Both pages on both sides, without a stream.
struct PageWords : ::testing::Test {
  VitalPage vital, vital_copy;
  PermitPage permit, permit_copy;
  SupervisorWords supervisor{vital_copy, permit};
  MemberWords member{vital, permit_copy};
  std::array<std::byte, StreamWords::max_octets> room{};

  static Octets told(StreamWords& words, MutableOctets room) {
    OctetWriter writer{room};
    words.tell(writer);
    EXPECT_TRUE(writer.good());
    return writer.written();
  }
  void carry() {
    ASSERT_TRUE(member.hear(told(supervisor, room)));
    ASSERT_TRUE(supervisor.hear(told(member, room)));
  }
  [[nodiscard]] bool may_move() const { return permit_copy.permits(permit_copy.epoch.load()); }
};

TEST_F(PageWords, EachWordOfTheVitalPageArrivesInItsPlace) {
  vital.state = static_cast<std::uint32_t>(State::Operational);
  vital.configuration = 2;
  vital.inhibited = 3;
  vital.seen_epoch = 4;
  vital.realtime = 1;
  vital.cycling = 1;
  vital.period_ns = 5;
  vital.cycles = 6;
  vital.service_steps = 7;
  vital.overruns = 8;
  vital.missed = 9;
  vital.latency_max_ns = 10;
  vital.execution_max_ns = 11;
  vital.execution_mean_ns = 12;
  vital.lost_reports = 13;
  vital.inhibited_at_cycle = 14;
  std::uint32_t number = 15;
  for (IncomingLink& link : vital.incoming)
    for (auto* word :
         {&link.link, &link.lost, &link.latency_mean_ns, &link.latency_max_ns, &link.jitter_ns, &link.age_us})
      *word = number++;
  carry();
  EXPECT_EQ(vital_copy.state.load(), static_cast<std::uint32_t>(State::Operational));
  EXPECT_EQ(vital_copy.configuration.load(), 2u);
  EXPECT_EQ(vital_copy.inhibited, 3u);
  EXPECT_EQ(vital_copy.seen_epoch, 4u);
  EXPECT_EQ(vital_copy.realtime.load(), 1u);
  EXPECT_EQ(vital_copy.cycling.load(), 1u);
  EXPECT_EQ(vital_copy.period_ns, 5u);
  EXPECT_EQ(vital_copy.cycles, 6u);
  EXPECT_EQ(vital_copy.service_steps, 7u);
  EXPECT_EQ(vital_copy.overruns, 8u);
  EXPECT_EQ(vital_copy.missed, 9u);
  EXPECT_EQ(vital_copy.latency_max_ns, 10u);
  EXPECT_EQ(vital_copy.execution_max_ns, 11u);
  EXPECT_EQ(vital_copy.execution_mean_ns, 12u);
  EXPECT_EQ(vital_copy.lost_reports, 13u);
  EXPECT_EQ(vital_copy.inhibited_at_cycle, 14u);
  number = 15;
  for (IncomingLink& link : vital_copy.incoming)
    for (const auto* word :
         {&link.link, &link.lost, &link.latency_mean_ns, &link.latency_max_ns, &link.jitter_ns, &link.age_us})
      EXPECT_EQ(*word, number++);
}

TEST_F(PageWords, OnlyLinksThatAreThereTravelAndThoseThatWentAreGone) {
  vital.incoming[0].link = 3;
  vital.incoming[2].link = 4;
  vital.incoming[2].age_us = 5;
  carry();
  EXPECT_EQ(vital_copy.incoming[0].link, 3u);
  EXPECT_EQ(vital_copy.incoming[1].link, 0u);
  EXPECT_EQ(vital_copy.incoming[2].link, 4u);
  EXPECT_EQ(vital_copy.incoming[2].age_us, 5u);
  vital.incoming[2].link = 0;
  carry();
  EXPECT_EQ(vital_copy.incoming[0].link, 3u);
  EXPECT_EQ(vital_copy.incoming[2].link, 0u);
}

TEST_F(PageWords, PermissionModeAndHeartbeatArrive) {
  permit.epoch = 1000;
  permit.release();
  permit.mode_epoch = 5;
  permit.newest_stop = 9;
  permit.heartbeat = 6;
  EXPECT_FALSE(may_move());
  carry();
  EXPECT_TRUE(may_move());
  EXPECT_EQ(permit_copy.epoch, 1001u);
  EXPECT_EQ(permit_copy.mode_epoch, 5u);
  EXPECT_EQ(permit_copy.newest_stop, 9u);
  EXPECT_EQ(permit_copy.heartbeat, 6u);
  permit.fence();
  carry();
  EXPECT_FALSE(may_move());
  EXPECT_EQ(permit_copy.epoch, 1002u);
  EXPECT_EQ(permit_copy.stop, 1u);
}

TEST_F(PageWords, DamageOfThePageIsDamageOfItsCopy) {
  reinterpret_cast<std::uint32_t&>(vital.state) ^= 1;
  reinterpret_cast<std::uint32_t&>(vital.cycling) ^= 1;
  carry();
  EXPECT_GT(vital_copy.state.load(), static_cast<std::uint32_t>(State::SoftwareDeinit));
  EXPECT_GT(vital_copy.cycling.load(), 1u);
  vital.state = 0;
  vital.magic ^= 1;
  carry();
  EXPECT_GT(vital_copy.state.load(), static_cast<std::uint32_t>(State::SoftwareDeinit));
}

TEST_F(PageWords, NoFlippedBitOfTheWordsPermitsAnything) {
  permit.fence();
  const Octets words = told(supervisor, room);
  for (std::size_t bit = 0; bit < words.size() * 8; ++bit) {
    auto flipped = room;
    flipped[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    ASSERT_TRUE(member.hear(Octets{flipped}.first(words.size())));
    EXPECT_FALSE(may_move()) << bit;
  }
}

TEST_F(PageWords, ThatAreTooShortOrTooLongAreRefusedAndChangeNothing) {
  permit.release();
  vital.state = 3;
  for (StreamWords* teller : {static_cast<StreamWords*>(&supervisor), static_cast<StreamWords*>(&member)}) {
    StreamWords& hearer = teller == &supervisor ? static_cast<StreamWords&>(member) : supervisor;
    const std::size_t octets = told(*teller, room).size();
    for (const std::size_t wrong : {std::size_t{0}, octets - 1, octets + 1})
      EXPECT_EQ(hearer.hear(Octets{room}.first(wrong)).error().code, ErrorCode::Malformed) << wrong;
  }
  EXPECT_FALSE(may_move());
  EXPECT_EQ(vital_copy.state.load(), 0u);
}

TEST_F(PageWords, WhatWasShutOpensWithALaterPermissionOnly) {
  permit.release();
  carry();
  member.shut();
  EXPECT_FALSE(may_move());
  carry();
  EXPECT_FALSE(may_move()) << "the supervisor has not permitted anew";
  permit.release();
  carry();
  EXPECT_TRUE(may_move());
}

/// A subsystem's port on a real stream whose other end is the supervisor's words.
struct StreamSubsystemPortTest : PageWords {
  StreamSubsystemPortTest() {
    auto ends = StreamChannel::make_pair().value();
    far.emplace(std::move(ends.first), supervisor);
    port.emplace(std::move(ends.second), vital, permit_copy);
    permit.release();
    step();
    EXPECT_TRUE(may_move());
  }
  void step() {
    far->step(now);
    port->step(now);
  }
  std::optional<StreamChannel> far;
  std::optional<StreamSubsystemPort> port;
  TimePoint now{std::chrono::seconds{1}};
};

TEST_F(StreamSubsystemPortTest, AFenceIsThereWithTheNextStep) {
  permit.fence();
  step();
  EXPECT_FALSE(may_move());
}

TEST_F(StreamSubsystemPortTest, SilenceShutsAndTheSameWordsDoNotOpenAgain) {
  now += StreamSubsystemPort::silence_limit;
  port->step(now);
  EXPECT_TRUE(may_move());
  port->step(now + Duration{1});
  EXPECT_FALSE(may_move());
  now += StreamSubsystemPort::silence_limit;
  step();
  EXPECT_FALSE(may_move());
  EXPECT_FALSE(port->closed());
  permit.release();
  step();
  EXPECT_TRUE(may_move());
}

TEST_F(StreamSubsystemPortTest, AClosedStreamShutsAtOnce) {
  far.reset();
  port->step(now);
  EXPECT_FALSE(may_move());
  EXPECT_TRUE(port->closed());
}

}  // namespace
}  // namespace hirosco
