// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "hirosco/data_transfer/channel/channel.hpp"

/// What every Channel must do. `Ends` has: Channel& first(), second(); void close_first(); MemoryHandle memory().
namespace hirosco::testing {

template <class Ends>
class ChannelConformance : public ::testing::Test {
 protected:
  static std::vector<std::byte> packet(std::size_t octets, int seed) {
    std::vector<std::byte> made(octets);
    for (std::size_t i = 0; i < octets; ++i) made[i] = static_cast<std::byte>(static_cast<int>(i) * 7 + seed);
    return made;
  }
  Result<> send(Octets octets) {
    Message message;
    message.packet = octets;
    return ends_.first().send(message);
  }
  Result<Channel::Found> receive() { return ends_.second().receive(buffer_); }

  Ends ends_;
  MessageBuffer buffer_{};
};

TYPED_TEST_SUITE_P(ChannelConformance);

TYPED_TEST_P(ChannelConformance, FindsNothingWhereNothingWasSent) {
  EXPECT_EQ(this->receive().value().flow, Flow::None);
}

TYPED_TEST_P(ChannelConformance, CarriesEveryFieldOfAMessage) {
  const auto octets = this->packet(20, 3);
  ASSERT_TRUE(this->ends_.first().send({MessageKind::GroundTelecommand, 0xDEAD'BEEF, 0x1234, octets, {}}));
  const auto found = this->receive().value();
  ASSERT_EQ(found.flow, Flow::New);
  EXPECT_EQ(found.message.kind, MessageKind::GroundTelecommand);
  EXPECT_EQ(found.message.epoch, 0xDEAD'BEEF);
  EXPECT_EQ(found.message.link, 0x1234);
  EXPECT_TRUE(std::ranges::equal(found.message.packet, octets));
  EXPECT_FALSE(found.message.memory);
}

TYPED_TEST_P(ChannelConformance, KeepsOrderAndBoundariesUpToTheLargestPacket) {
  const std::size_t sizes[]{1, max_packet_octets, 7, 0, 500};
  for (const std::size_t size : sizes) ASSERT_TRUE(this->send(this->packet(size, static_cast<int>(size))));
  for (const std::size_t size : sizes) {
    const auto found = this->receive().value();
    ASSERT_EQ(found.flow, Flow::New);
    EXPECT_TRUE(std::ranges::equal(found.message.packet, this->packet(size, static_cast<int>(size)))) << size;
  }
  EXPECT_EQ(this->receive().value().flow, Flow::None);
}

TYPED_TEST_P(ChannelConformance, RefusesAPacketThatIsTooLong) {
  EXPECT_EQ(this->send(this->packet(max_packet_octets + 1, 0)).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(this->receive().value().flow, Flow::None);
}

TYPED_TEST_P(ChannelConformance, CarriesTheHandleOfMemory) {
  const auto octets = this->packet(8, 1);
  ASSERT_TRUE(this->ends_.first().send({MessageKind::Packet, 0, 0, octets, this->ends_.memory()}));
  const auto found = this->receive().value();
  ASSERT_TRUE(found.message.memory);
  EXPECT_TRUE(this->ends_.same_memory(found.message.memory));
}

TYPED_TEST_P(ChannelConformance, SaysSoWhenThePeerDoesNotRead) {
  const auto octets = this->packet(64, 1);
  int accepted = 0;
  Result<> sent = ok();
  while (accepted < 100'000 && (sent = this->send(octets))) ++accepted;
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().code, ErrorCode::ResourceExhausted);
  int read = 0;
  while (this->receive().value().flow == Flow::New) ++read;
  EXPECT_EQ(read, accepted) << "what was accepted arrives";
  EXPECT_TRUE(this->send(octets)) << "there is room again";
}

TYPED_TEST_P(ChannelConformance, TakesSeveralInOrderAndSaysHowMany) {
  std::vector<std::vector<std::byte>> packets;
  std::vector<Message> messages;
  for (int i = 0; i < 100; ++i) packets.push_back(this->packet(static_cast<std::size_t>(i) * 3, i));
  for (const auto& octets : packets) messages.push_back({.link = 7, .packet = octets});
  messages[40].memory = this->ends_.memory();
  EXPECT_EQ(this->ends_.first().send_all(messages), messages.size());
  for (int i = 0; i < 100; ++i) {
    const auto found = this->receive().value();
    ASSERT_EQ(found.flow, Flow::New);
    EXPECT_TRUE(std::ranges::equal(found.message.packet, packets[static_cast<std::size_t>(i)])) << i;
    EXPECT_EQ(found.message.link, 7);
    EXPECT_EQ(static_cast<bool>(found.message.memory), i == 40);
  }
  EXPECT_EQ(this->receive().value().flow, Flow::None);
}

TYPED_TEST_P(ChannelConformance, TakesOfSeveralWhatThereIsRoomForAndNothingBehindOneThatIsTooLong) {
  const auto octets = this->packet(64, 1);
  const auto too_long = this->packet(max_packet_octets + 1, 0);
  const std::vector<Message> mixed{{.packet = octets}, {.packet = octets}, {.packet = too_long}, {.packet = octets}};
  EXPECT_EQ(this->ends_.first().send_all(mixed), 2U);
  const std::vector<Message> many(100'000, {.packet = octets});
  const std::size_t sent = this->ends_.first().send_all(many);
  EXPECT_GT(sent, 0U);
  EXPECT_LT(sent, many.size());
  std::size_t read = 0;
  while (this->receive().value().flow == Flow::New) ++read;
  EXPECT_EQ(read, 2 + sent) << "what was accepted arrives, nothing else";
  this->ends_.close_first();
  EXPECT_EQ(this->ends_.second().send_all(mixed), 0U);
}

TYPED_TEST_P(ChannelConformance, DeliversWhatWasSentBeforeThePeerWentAndThenSaysSo) {
  ASSERT_TRUE(this->send(this->packet(9, 1)));
  this->ends_.close_first();
  EXPECT_EQ(this->receive().value().flow, Flow::New);
  EXPECT_EQ(this->receive().error().code, ErrorCode::Unavailable);
  EXPECT_EQ(this->ends_.second().send({}).error().code, ErrorCode::Unavailable);
}

REGISTER_TYPED_TEST_SUITE_P(ChannelConformance, FindsNothingWhereNothingWasSent, CarriesEveryFieldOfAMessage,
                            KeepsOrderAndBoundariesUpToTheLargestPacket, RefusesAPacketThatIsTooLong,
                            CarriesTheHandleOfMemory, SaysSoWhenThePeerDoesNotRead, TakesSeveralInOrderAndSaysHowMany,
                            TakesOfSeveralWhatThereIsRoomForAndNothingBehindOneThatIsTooLong,
                            DeliversWhatWasSentBeforeThePeerWentAndThenSaysSo);

}  // namespace hirosco::testing
