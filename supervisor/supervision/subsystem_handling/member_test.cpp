// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/member.hpp"

#include <gtest/gtest.h>

#include <new>

#include "hirosco/data_transfer/control/channel_pair.hpp"
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
    launched.channel = std::make_unique<OwnEnd>();
    launched.vital = page(sizeof(VitalPage));
    launched.permit = page(sizeof(PermitPage));
    launched.process = 7;
    vital = new (launched.vital.octets.data()) VitalPage{};
    permit = new (launched.permit.octets.data()) PermitPage{};
    member.started(std::move(launched));
  }
};

TEST_F(MemberTest, OneThatNeverStartedHasNothingAndFearsNothing) {
  EXPECT_FALSE(member.alive());
  EXPECT_EQ(member.vital(), nullptr);
  EXPECT_EQ(member.state(), std::nullopt);
  EXPECT_EQ(member.configuration(), 0);
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

TEST_F(MemberTest, ADeadOneIsGoneWithItsPages) {
  start();
  member.recovering = descriptor::Severity::High;
  member.died();
  EXPECT_FALSE(member.alive());
  EXPECT_EQ(member.state(), std::nullopt);
  start();
  EXPECT_EQ(member.recovering, std::nullopt);
}

}  // namespace
}  // namespace hirosco::supervisor
