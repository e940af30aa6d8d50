// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/members/member.hpp"

#include <gtest/gtest.h>

#include <new>

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

struct OwnEnd final : Channel {
  Result<> send(const Message& message) override { return pair.supervisor_end().send(message); }
  Result<Found> receive(MessageBuffer& buffer) override { return pair.supervisor_end().receive(buffer); }
  ChannelPair pair;
};

struct MemberTest : ::testing::Test {
  descriptor::Mission mission = testing::small_mission();
  HeapMemory memory;
  Member member{mission.subsystems[0]};
  VitalPage* vital{nullptr};
  PermitPage* permit{nullptr};

  void start() {
    const auto page = [&](std::size_t octets) {
      return memory.map(memory.create("page", octets).value(), Access::ReadWrite).value();
    };
    LaunchedSubsystem launched;
    launched.vital = page(sizeof(VitalPage));
    launched.permit = page(sizeof(PermitPage));
    launched.process = 7;
    vital = new (launched.vital.octets.data()) VitalPage{};
    permit = new (launched.permit.octets.data()) PermitPage{};
    launched.port = std::make_unique<LocalMemberPort>(std::make_unique<OwnEnd>(), launched.vital, launched.permit);
    member.started(std::move(launched));
  }
};

TEST_F(MemberTest, OneThatNeverStartedHasNothingAndFearsNothing) {
  EXPECT_FALSE(member.alive());
  EXPECT_EQ(member.channel(), nullptr);
  EXPECT_FALSE(member.statistics());
  EXPECT_EQ(member.state(), std::nullopt);
  EXPECT_EQ(member.configuration(), 0);
  EXPECT_EQ(member.stopped_at_cycle(), 0u);
  member.enter_mode(5);
  member.beat(6, {});
}

TEST_F(MemberTest, ItsStateIsThatOfTheVitalPage) {
  start();
  EXPECT_TRUE(member.alive());
  EXPECT_EQ(member.process(), 7u);
  EXPECT_EQ(member.state(), State::Offline);
  vital->state = static_cast<std::uint32_t>(State::Operational);
  vital->configuration = 2;
  EXPECT_EQ(member.state(), State::Operational);
  EXPECT_EQ(member.configuration(), 2);
}

TEST_F(MemberTest, APageThatIsNotOneIsNotBelieved) {
  start();
  vital->state = 10;
  EXPECT_EQ(member.state(), std::nullopt);
  vital->state = 3;
  EXPECT_TRUE(member.statistics());
  vital->magic = 0;
  EXPECT_EQ(member.state(), std::nullopt);
  EXPECT_FALSE(member.statistics());
  EXPECT_EQ(member.configuration(), 0);
  vital->magic = page_magic;
  vital->version = page_version + 1;
  EXPECT_EQ(member.state(), std::nullopt);
}

TEST_F(MemberTest, HeartbeatAndModeStandInItsPermitPage) {
  start();
  member.enter_mode(5);
  member.beat(6, {});
  permit->stopped_at_cycle = 7;
  EXPECT_EQ(permit->mode_epoch, 5u);
  EXPECT_EQ(permit->heartbeat, 6u);
  EXPECT_EQ(member.stopped_at_cycle(), 7u);
}

TEST_F(MemberTest, ItsStatisticsAreEachWordOfItsVitalPage) {
  start();
  vital->inhibited = 1;
  vital->realtime = 1;
  vital->cycling = 1;
  vital->period_ns = 2;
  vital->cycles = 3;
  vital->overruns = 4;
  vital->missed = 5;
  vital->latency_max_ns = 6;
  vital->execution_mean_ns = 7;
  vital->inhibited_at_cycle = 8;
  vital->incoming[1].link = 9;
  vital->incoming[1].lost = 10;
  vital->incoming[1].latency_mean_ns = 11;
  vital->incoming[1].latency_max_ns = 12;
  vital->incoming[1].jitter_ns = 13;
  vital->incoming[1].age_us = 14;
  const auto seen = member.statistics().value();
  EXPECT_EQ(seen.inhibited, 1u);
  EXPECT_TRUE(seen.realtime);
  EXPECT_TRUE(seen.cycling);
  EXPECT_EQ(seen.period_ns, 2u);
  EXPECT_EQ(seen.cycles, 3u);
  EXPECT_EQ(seen.overruns, 4u);
  EXPECT_EQ(seen.missed, 5u);
  EXPECT_EQ(seen.latency_max_ns, 6u);
  EXPECT_EQ(seen.execution_mean_ns, 7u);
  EXPECT_EQ(seen.inhibited_at_cycle, 8u);
  EXPECT_EQ(seen.incoming[0].link, 0u);
  EXPECT_EQ(seen.incoming[1].link, 9u);
  EXPECT_EQ(seen.incoming[1].lost, 10u);
  EXPECT_EQ(seen.incoming[1].latency_mean_ns, 11u);
  EXPECT_EQ(seen.incoming[1].latency_max_ns, 12u);
  EXPECT_EQ(seen.incoming[1].jitter_ns, 13u);
  EXPECT_EQ(seen.incoming[1].age_us, 14u);
}

TEST_F(MemberTest, TheLatenciesOfALinkAreThoseOfItsPlaceAndOfDamageNothing) {
  start();
  vital->latencies[1].period_ns = 7;
  for (std::uint32_t bin = 0; bin < latency_bins; ++bin) vital->latencies[1].counts[bin] = 20 + bin;
  const MemberLatencies seen = member.latencies(1);
  EXPECT_EQ(seen.period_ns, 7u);
  for (std::uint32_t bin = 0; bin < latency_bins; ++bin) EXPECT_EQ(seen.counts[bin], 20 + bin);
  EXPECT_EQ(member.latencies(0).period_ns, 0u);
  EXPECT_EQ(member.latencies(told_incoming_links).period_ns, 0u);
  vital->magic ^= 1;
  EXPECT_EQ(member.latencies(1).period_ns, 0u);
}

TEST_F(MemberTest, ADeadOneIsGoneWithItsPages) {
  start();
  member.recovery.plan_begins(descriptor::Severity::High);
  member.died();
  EXPECT_FALSE(member.alive());
  EXPECT_EQ(member.state(), std::nullopt);
  start();
  EXPECT_FALSE(member.recovery.running());
}

}  // namespace
}  // namespace hirosco::supervisor
