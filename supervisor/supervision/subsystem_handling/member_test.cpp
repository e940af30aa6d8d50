// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/member.hpp"

#include <gtest/gtest.h>

#include <new>

#include "hirosco/data_transfer/simulated/channel_pair.hpp"
#include "hirosco/data_transfer/simulated/heap_memory.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

struct OwnEnd final : Channel {
  Result<> send(const Message& message) override { return pair.supervisor_end().send(message); }
  Result<Found> receive(MessageBuffer& buffer) override { return pair.supervisor_end().receive(buffer); }
  ChannelPair pair;
};

struct MemberTest : ::testing::Test {
  descriptor::Mission mission = [] {
    auto made = testing::small_mission();
    made.subsystems[0].subsystem.hang = {20, 200};
    return made;
  }();
  HeapMemory memory;
  Member member{mission.subsystems[0]};
  VitalPage* vital{nullptr};
  PermitPage* permit{nullptr};

  void start() {
    const auto page = [&](std::size_t octets) {
      return memory.map(memory.create("page", octets).value(), Access::ReadWrite).value();
    };
    LaunchedSubsystem launched;
    launched.channel = std::make_unique<OwnEnd>();
    launched.vital = page(sizeof(VitalPage));
    launched.permit = page(sizeof(PermitPage));
    launched.process = 7;
    vital = new (launched.vital.octets.data()) VitalPage{};
    permit = new (launched.permit.octets.data()) PermitPage{};
    member.started(std::move(launched));
  }
  /// In which observation a hang is found, 0 = in none of `limit`.
  int observations_until_hang(int limit) {
    for (int i = 1; i <= limit; ++i)
      if (member.hang_detected()) return i;
    return 0;
  }
};

TEST_F(MemberTest, OneThatNeverStartedHasNothingAndFearsNothing) {
  EXPECT_FALSE(member.alive());
  EXPECT_EQ(member.vital(), nullptr);
  EXPECT_EQ(member.state(), std::nullopt);
  EXPECT_EQ(member.configuration(), 0);
  member.fence();
  member.release_fence();
  EXPECT_FALSE(member.fenced());
  EXPECT_FALSE(member.hang_detected());
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
  vital->magic = 0;
  EXPECT_EQ(member.state(), std::nullopt);
  vital->magic = page_magic;
  vital->version = page_version + 1;
  EXPECT_EQ(member.state(), std::nullopt);
}

TEST_F(MemberTest, AFenceStopsAndRaisesTheEpochItsReleaseKeepsTheEpoch) {
  start();
  const auto epoch = permit->epoch.load();
  member.fence();
  EXPECT_EQ(permit->stop.load(), 1u);
  EXPECT_GT(permit->epoch.load(), epoch);
  EXPECT_TRUE(member.fenced());
  const auto fenced = permit->epoch.load();
  member.release_fence();
  EXPECT_FALSE(member.fenced());
  EXPECT_EQ(permit->epoch.load(), fenced);
}

TEST_F(MemberTest, ACycleThatStandsStillForTheLimitIsAHangOnce) {
  start();
  vital->cycling = 1;
  vital->realtime = 1;
  vital->cycles = 5;
  EXPECT_FALSE(member.hang_detected());
  EXPECT_EQ(observations_until_hang(1'000), 20);
  EXPECT_EQ(observations_until_hang(1'000), 0);
  vital->cycles = 6;
  EXPECT_FALSE(member.hang_detected());
  EXPECT_EQ(observations_until_hang(1'000), 20);
}

TEST_F(MemberTest, WithoutRealtimeTheReducedLimitHolds) {
  start();
  vital->cycling = 1;
  vital->cycles = 5;
  EXPECT_FALSE(member.hang_detected());
  EXPECT_EQ(observations_until_hang(1'000), 200);
}

TEST_F(MemberTest, ACycleThatAdvancesOrRestsIsNoHang) {
  start();
  vital->realtime = 1;
  EXPECT_EQ(observations_until_hang(100), 0);
  vital->cycling = 1;
  for (int i = 0; i < 100; ++i) {
    vital->cycles.fetch_add(1);
    EXPECT_FALSE(member.hang_detected());
  }
}

TEST_F(MemberTest, ADeadOneIsGoneWithItsPages) {
  start();
  member.recovering = descriptor::Severity::High;
  member.died();
  EXPECT_FALSE(member.alive());
  EXPECT_EQ(member.state(), std::nullopt);
  EXPECT_FALSE(member.fenced());
  start();
  EXPECT_EQ(member.recovering, std::nullopt);
}

}  // namespace
}  // namespace hirosco::supervisor
