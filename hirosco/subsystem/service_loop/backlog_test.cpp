// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/backlog.hpp"

#include <gtest/gtest.h>

#include "hirosco/data_transfer/channel/channel_pair.hpp"

namespace hirosco {
namespace {

using Worth = Backlog::Worth;
constexpr std::size_t most_waiting = descriptor::default_waiting;
constexpr std::size_t most_long_waiting = descriptor::waiting_pools(descriptor::default_waiting)[2].blocks;

struct BacklogTest : ::testing::Test {
  ChannelPair channels{4};
  Backlog backlog;

  void send(int content, Worth worth, MessageKind kind = MessageKind::Packet) {
    const std::byte octet{static_cast<std::uint8_t>(content)};
    backlog.send(channels.subsystem_end(), {.kind = kind, .packet = {&octet, 1}}, worth);
  }
  /// All that arrives until nothing is left, "1 2 3".
  std::string received() {
    std::string text;
    MessageBuffer buffer;
    for (;;) {
      backlog.flush(channels.subsystem_end());
      const auto found = channels.supervisor_end().receive(buffer);
      if (!found || found->flow == Flow::None) return text;
      text += (text.empty() ? "" : " ") + std::to_string(std::to_integer<int>(found->message.packet[0]));
      if (found->message.kind == MessageKind::Event) text += 'e';
    }
  }
};

TEST_F(BacklogTest, SendsWhatHasRoomAtOnceAndInOrder) {
  for (int i = 1; i <= 4; ++i) send(i, i % 2 == 0 ? Worth::Housekeeping : Worth::Answer);
  EXPECT_TRUE(backlog.empty());
  EXPECT_EQ(received(), "1 2 3 4");
}

TEST_F(BacklogTest, SendsWhatWaitedByItsWorthAndEachKindInOrder) {
  for (int i = 1; i <= 4; ++i) send(i, Worth::Answer);
  send(10, Worth::Housekeeping);
  send(20, Worth::Event, MessageKind::Event);
  send(30, Worth::Answer);
  send(11, Worth::Housekeeping);
  send(31, Worth::Answer);
  EXPECT_EQ(received(), "1 2 3 4 30 31 20e 10 11");
}

TEST_F(BacklogTest, AnAnswerDoesNotQueueBehindHousekeeping) {
  for (int i = 1; i <= 4; ++i) send(i, Worth::Answer);
  send(10, Worth::Housekeeping);
  MessageBuffer buffer;
  ASSERT_TRUE(channels.supervisor_end().receive(buffer));
  send(5, Worth::Answer);
  EXPECT_EQ(received(), "2 3 4 5 10");
}

TEST_F(BacklogTest, AFloodOfOneKindCostsNothingOfAnother) {
  for (int i = 1; i <= 4; ++i) send(i, Worth::Answer);
  send(99, Worth::Answer);
  for (std::size_t i = 0; i < 3 * most_waiting; ++i) send(7, Worth::Housekeeping);
  for (std::size_t i = 0; i < 2 * most_waiting; ++i) send(8, Worth::Event);
  EXPECT_EQ(backlog.lost(Worth::Answer), 0u);
  EXPECT_EQ(backlog.lost(Worth::Event), most_waiting);
  EXPECT_EQ(backlog.lost(Worth::Housekeeping), 2 * most_waiting);
  EXPECT_TRUE(received().starts_with("1 2 3 4 99 8 "));
}

TEST_F(BacklogTest, LongMessagesHaveBlocksOfTheirOwnAndLoseTheirOldestBeyond) {
  for (int i = 1; i <= 4; ++i) send(i, Worth::Answer);
  std::vector<std::byte> longest(max_packet_octets);
  for (std::size_t i = 0; i < most_long_waiting + 2; ++i) {
    longest[0] = static_cast<std::byte>(100 + i);
    backlog.send(channels.subsystem_end(), {.packet = longest}, Worth::Housekeeping);
  }
  EXPECT_EQ(backlog.lost(Worth::Housekeeping), 2U);
  EXPECT_TRUE(backlog.answers_have_room());
  const std::string all = received();
  EXPECT_TRUE(all.starts_with("1 2 3 4 102 103 ")) << all;
  for (int i = 1; i <= 4; ++i) send(i, Worth::Answer);
  for (std::size_t i = 0; i < most_long_waiting / 2; ++i)
    backlog.send(channels.subsystem_end(), {.packet = longest}, Worth::Answer);
  EXPECT_FALSE(backlog.answers_have_room()) << "those to one more telecommand could be as long";
}

TEST_F(BacklogTest, AFullQueueLosesItsOldest) {
  for (int i = 1; i <= 4; ++i) send(i, Worth::Answer);
  for (std::size_t i = 0; i < most_waiting; ++i) send(i == 0 ? 50 : 60, Worth::Answer);
  send(70, Worth::Answer);
  EXPECT_EQ(backlog.lost(Worth::Answer), 1u);
  const std::string all = received();
  EXPECT_EQ(all.find("50"), std::string::npos);
  EXPECT_TRUE(all.ends_with("60 70"));
}

TEST_F(BacklogTest, HoldsAsManyOfEachKindAsTheDescriptorSaysAndTellsHowManyHaveWaited) {
  Backlog small{{128, 200, 1024}};
  const std::byte octet{1};
  const auto flood = [&](Worth worth) {
    for (int i = 0; i < 300; ++i)
      small.send(channels.subsystem_end(), {.kind = MessageKind::Packet, .packet = {&octet, 1}}, worth);
  };
  for (const Worth worth : {Worth::Answer, Worth::Event, Worth::Housekeeping}) flood(worth);
  EXPECT_EQ(small.lost(Worth::Answer), 300U - 4 - 128) << "four went through the channel";
  EXPECT_EQ(small.lost(Worth::Event), 100U);
  EXPECT_EQ(small.lost(Worth::Housekeeping), 0U);
  EXPECT_EQ(small.take_most_waiting(), (descriptor::Waiting{128, 200, 300}));
  MessageBuffer buffer;
  while (!small.empty()) {
    ASSERT_TRUE(channels.supervisor_end().receive(buffer));
    small.flush(channels.subsystem_end());
  }
  EXPECT_EQ(small.take_most_waiting(), (descriptor::Waiting{128, 200, 300})) << "of the time in between";
  EXPECT_EQ(small.take_most_waiting(), descriptor::Waiting{});
}

TEST_F(BacklogTest, HasRoomForMoreAnswersUntilHalfOfItIsFullOfThemAndNeverWaitsForSomebodyWhoIsGone) {
  for (std::size_t i = 0; i < 4 + 3 * most_waiting; ++i) send(7, Worth::Housekeeping);
  EXPECT_TRUE(backlog.answers_have_room()) << "housekeeping takes none of it";
  for (std::size_t i = 0; i < most_waiting / 2; ++i) {
    EXPECT_TRUE(backlog.answers_have_room()) << i;
    send(1, Worth::Answer);
  }
  EXPECT_FALSE(backlog.answers_have_room());
  MessageBuffer buffer;
  ASSERT_TRUE(channels.supervisor_end().receive(buffer));
  backlog.flush(channels.subsystem_end());
  EXPECT_TRUE(backlog.answers_have_room());
  send(1, Worth::Answer);
  EXPECT_FALSE(backlog.answers_have_room());
  channels.close_supervisor_end();
  backlog.flush(channels.subsystem_end());
  EXPECT_TRUE(backlog.answers_have_room());
}

TEST_F(BacklogTest, AMessageThatNoChannelCarriesIsCountedAndHoldsUpNobody) {
  const std::vector<std::byte> endless(max_packet_octets + 1);
  backlog.send(channels.subsystem_end(), {.packet = endless}, Worth::Answer);
  send(1, Worth::Answer);
  EXPECT_EQ(backlog.lost(Worth::Answer), 1u);
  EXPECT_EQ(received(), "1");
}

}  // namespace
}  // namespace hirosco
