// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/member_channel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/data_transfer/channel/socket_channel.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;

/// A channel that takes so many messages before its member reads.
struct MemberChannelTest : ::testing::Test {
  static constexpr std::size_t capacity = 3;
  ChannelPair pair{capacity};
  MemberChannel channel{pair.supervisor_end()};
  TimePoint now{10s};

  static std::array<std::byte, 1> octet(int number) { return {static_cast<std::byte>(number)}; }
  ErrorCode code_of(const Result<>& sent) { return sent ? ErrorCode::Internal : sent.error().code; }
  Result<> say(int number) { return channel.send({.packet = octet(number)}); }
  Result<> keep(int number) { return channel.send_or_keep({.packet = octet(number)}, now); }
  void fill() {
    for (int i = 0; i < static_cast<int>(capacity); ++i) ASSERT_TRUE(say(i));
  }
  std::vector<int> read(std::size_t most = 1000) {
    std::vector<int> numbers;
    MessageBuffer buffer;
    while (numbers.size() < most) {
      const auto found = pair.subsystem_end().receive(buffer);
      if (!found || found->flow == Flow::None) break;
      numbers.push_back(std::to_integer<int>(found->message.packet[0]));
    }
    return numbers;
  }
};

TEST_F(MemberChannelTest, WhatFindsRoomLeavesAtOnce) {
  ASSERT_TRUE(keep(1));
  ASSERT_TRUE(say(2));
  EXPECT_THAT(read(), ElementsAre(1, 2));
}

TEST_F(MemberChannelTest, WhatIsKeptHasTheFirstPlaceThatBecomesFreeWhoeverSpeaksFirst) {
  fill();
  EXPECT_EQ(code_of(say(9)), ErrorCode::ResourceExhausted);
  ASSERT_TRUE(keep(20));
  ASSERT_TRUE(keep(21));
  EXPECT_THAT(read(1), ElementsAre(0));
  EXPECT_EQ(code_of(say(9)), ErrorCode::ResourceExhausted) << "that place was not for this one";
  EXPECT_THAT(read(1), ElementsAre(1));
  const auto more = octet(9);
  EXPECT_EQ(channel.send_all(std::array{Message{.packet = more}}), 0U);
  EXPECT_THAT(read(), ElementsAre(2, 20, 21));
  const std::array<Message, 1> one{Message{.packet = more}};
  EXPECT_EQ(channel.send_all(one), 1U);
  EXPECT_THAT(read(), ElementsAre(9)) << "once";
}

TEST_F(MemberChannelTest, WhatIsKeptLeavesWithTheStepsThoughNobodySpeaks) {
  fill();
  ASSERT_TRUE(keep(20));
  channel.step(now);
  EXPECT_THAT(read(), ElementsAre(0, 1, 2));
  channel.step(now);
  EXPECT_THAT(read(), ElementsAre(20));
}

TEST_F(MemberChannelTest, NoMoreIsKeptThanThereIsRoomForNorForLongerThanItsTime) {
  fill();
  for (std::size_t i = 0; i < MemberChannel::most_kept; ++i) ASSERT_TRUE(keep(20));
  EXPECT_EQ(code_of(keep(21)), ErrorCode::ResourceExhausted);
  now += MemberChannel::patience - 1ms;
  channel.step(now);
  EXPECT_EQ(code_of(keep(21)), ErrorCode::ResourceExhausted);
  now += 1ms;
  channel.step(now);
  ASSERT_TRUE(keep(22));
  EXPECT_THAT(read(), ElementsAre(0, 1, 2));
  channel.step(now);
  EXPECT_THAT(read(), ElementsAre(22));
}

TEST_F(MemberChannelTest, ForWhoIsGoneNothingIsKept) {
  fill();
  ASSERT_TRUE(keep(20));
  pair.close_subsystem_end();
  EXPECT_EQ(code_of(keep(21)), ErrorCode::Unavailable);
  EXPECT_EQ(code_of(say(9)), ErrorCode::Unavailable);
}

TEST_F(MemberChannelTest, ItsMemoryGoesWithIt) {
  HeapMemory memory;
  fill();
  ASSERT_TRUE(channel.send_or_keep({.packet = octet(20), .memory = memory.create("link", 64).value()}, now));
  EXPECT_THAT(read(), ElementsAre(0, 1, 2));
  channel.step(now);
  MessageBuffer buffer;
  EXPECT_TRUE(pair.subsystem_end().receive(buffer).value().message.memory);
}

TEST(MemberChannel, OfASocketThatIsFullKeepsAlike) {
  auto ends = SocketChannel::make_pair().value();
  SocketChannel socket{std::move(ends.first)}, member{std::move(ends.second)};
  MemberChannel channel{socket};
  EXPECT_EQ(channel.wait_descriptor(), socket.wait_descriptor());
  const std::array filler{std::byte{1}}, kept{std::byte{20}};
  std::size_t full = 0;
  while (channel.send({.packet = filler})) ++full;
  ASSERT_TRUE(channel.send_or_keep({.packet = kept}, TimePoint{10s}));
  MessageBuffer buffer;
  std::size_t read = 0;
  for (;;) {
    const auto found = member.receive(buffer).value();
    ASSERT_EQ(found.flow, Flow::New);
    if (found.message.packet[0] == kept[0]) break;
    ++read;
    static_cast<void>(channel.send({.packet = filler}));
  }
  EXPECT_LE(read, full) << "ahead of all that was said after it";
  const auto answer = member.send({.packet = filler});
  ASSERT_TRUE(answer);
  EXPECT_EQ(channel.receive(buffer).value().flow, Flow::New);
}

}  // namespace
}  // namespace hirosco::supervisor
