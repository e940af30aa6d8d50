// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/thread_channel.hpp"

#include <gtest/gtest.h>

#include "hirosco/data_transfer/channel/testing/channel_conformance.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco::testing {
namespace {

class LocalEnds {
 public:
  Channel& first() { return *ends_.first; }
  Channel& second() { return *ends_.second; }
  void close_first() { ends_.first.reset(); }
  const MemoryHandle& memory() { return memory_; }
  bool same_memory(const MemoryHandle& handle) { return handle.block() == memory_.block(); }

 private:
  std::pair<std::unique_ptr<ThreadChannel>, std::unique_ptr<ThreadChannel>> ends_ = ThreadChannel::make_pair().value();
  MemoryHandle memory_ = HeapMemory{}.create("link", 64).value();
};

INSTANTIATE_TYPED_TEST_SUITE_P(Local, ChannelConformance, LocalEnds);

struct ThreadChannelTest : ::testing::Test {
  [[nodiscard]] static bool readable(int descriptor) {
    WaitSet set;
    EXPECT_TRUE(set.add(descriptor));
    return !set.wait(Duration{0}).value().empty();
  }
  std::pair<std::unique_ptr<ThreadChannel>, std::unique_ptr<ThreadChannel>> ends = ThreadChannel::make_pair().value();
  MessageBuffer buffer{};
};

TEST_F(ThreadChannelTest, WakesItsReaderUntilAllIsRead) {
  EXPECT_FALSE(readable(ends.second->wait_descriptor()));
  ASSERT_TRUE(ends.first->send({}));
  ASSERT_TRUE(ends.first->send({}));
  EXPECT_TRUE(readable(ends.second->wait_descriptor()));
  EXPECT_FALSE(readable(ends.first->wait_descriptor())) << "who sent has nothing to read";
  ASSERT_EQ(ends.second->receive(buffer).value().flow, Flow::New);
  EXPECT_TRUE(readable(ends.second->wait_descriptor())) << "there is another one";
  ASSERT_EQ(ends.second->receive(buffer).value().flow, Flow::New);
  ASSERT_EQ(ends.second->receive(buffer).value().flow, Flow::None);
  EXPECT_FALSE(readable(ends.second->wait_descriptor()));
}

TEST_F(ThreadChannelTest, APeerThatIsGoneWakesOnceAndDoesNotEndEveryWait) {
  ends.first.reset();
  EXPECT_TRUE(readable(ends.second->wait_descriptor()));
  EXPECT_EQ(ends.second->receive(buffer).error().code, ErrorCode::Unavailable);
  EXPECT_FALSE(readable(ends.second->wait_descriptor()));
}

TEST_F(ThreadChannelTest, TellsWhoFoundNoRoomWhenThereIsSome) {
  while (ends.first->send({})) {}
  EXPECT_FALSE(readable(ends.first->room_descriptor()));
  ASSERT_EQ(ends.second->receive(buffer).value().flow, Flow::New);
  EXPECT_TRUE(readable(ends.first->room_descriptor()));
  ASSERT_TRUE(ends.first->send({}));
  ASSERT_FALSE(ends.first->send({}));
  EXPECT_FALSE(readable(ends.first->room_descriptor())) << "it is full again";
}

TEST_F(ThreadChannelTest, WhoWaitsForRoomIsWokenByTheEndOfItsPeer) {
  while (ends.first->send({})) {}
  ends.second.reset();
  EXPECT_TRUE(readable(ends.first->room_descriptor()));
}

TEST_F(ThreadChannelTest, IsFullByOctetsBeforeItIsByMessagesAndLosesNoneOfThem) {
  const std::vector<std::byte> large(max_packet_octets, std::byte{7});
  std::size_t sent = 0;
  for (int round = 0; round < 3; ++round) {
    while (ends.first->send({.packet = large})) ++sent;
    for (int i = 0; i < 5; ++i) {
      const auto found = ends.second->receive(buffer).value();
      ASSERT_TRUE(std::ranges::equal(found.message.packet, large)) << "also one that goes round the end of the ring";
    }
  }
  EXPECT_EQ(sent, (ThreadChannel::default_kb << 10) / max_packet_octets + 10);
}

TEST(ThreadChannelOfASize, TakesAsManyMessagesAndKilobytesAsItIsToldAndSaysHowFullItIs) {
  auto ends = ThreadChannel::make_pair(64).value();
  EXPECT_EQ(ends.first->outbound().used, 0U);
  std::size_t sent = 0;
  for (; sent < 16; ++sent) ASSERT_TRUE(ends.first->send({}));
  EXPECT_EQ(ends.first->outbound().used * 4, ends.first->outbound().room) << "a quarter, by messages";
  while (ends.first->send({})) ++sent;
  EXPECT_EQ(sent, 64U);
  EXPECT_EQ(ends.first->outbound().used, ends.first->outbound().room);
  EXPECT_EQ(ends.second->outbound().used, 0U) << "the other way";
  MessageBuffer buffer;
  while (ends.second->receive(buffer).value().flow == Flow::New) {}
  const std::vector<std::byte> large(max_packet_octets, std::byte{7});
  for (int i = 0; i < 8; ++i) ASSERT_TRUE(ends.first->send({.packet = large}));
  EXPECT_EQ(ends.first->outbound().used * 2, ends.first->outbound().room) << "a half, by octets";
}

}  // namespace
}  // namespace hirosco::testing
