// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/socket_channel.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <optional>

#include "hirosco/data_transfer/channel/testing/channel_conformance.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/data_transfer/memory/testing/memory_conformance.hpp"

namespace hirosco::testing {
namespace {

ino_t inode(int descriptor) {
  struct stat status{};
  EXPECT_EQ(::fstat(descriptor, &status), 0);
  return status.st_ino;
}

class SocketEnds {
 public:
  SocketEnds() {
    auto ends = SocketChannel::make_pair().value();
    first_.emplace(std::move(ends.first));
    second_.emplace(std::move(ends.second));
  }
  Channel& first() { return *first_; }
  Channel& second() { return *second_; }
  void close_first() { first_.reset(); }
  const MemoryHandle& memory() { return memory_; }
  bool same_memory(const MemoryHandle& handle) {
    return inode(SealedMemory::descriptor(handle)) == inode(SealedMemory::descriptor(memory_)) &&
           SealedMemory{}.verify(handle, 64, false).has_value();
  }

 private:
  std::optional<SocketChannel> first_;
  std::optional<SocketChannel> second_;
  MemoryHandle memory_ = SealedMemory{}.create("link", 64).value();
};

INSTANTIATE_TYPED_TEST_SUITE_P(Sealed, MemoryConformance, SealedMemory);
INSTANTIATE_TYPED_TEST_SUITE_P(Socket, ChannelConformance, SocketEnds);

TEST(SocketChannelOfASize, TakesMoreOfTheSystemsMemoryTheLargerItIsEachWayAndSaysHowFullItIs) {
  std::array<int, 2> taken{};
  for (std::size_t i = 0; i < taken.size(); ++i) {
    constexpr std::array<std::uint32_t, 2> sizes_kb{64, 256};
    auto ends = SocketChannel::make_pair(sizes_kb[i]).value();
    SocketChannel first{std::move(ends.first)}, second{std::move(ends.second)};
    EXPECT_EQ(first.outbound().used, 0U);
    EXPECT_GE(first.outbound().room, sizes_kb[i] * 1024U);
    EXPECT_EQ(second.outbound().room, first.outbound().room);
    while (first.send({})) ++taken[i];
    EXPECT_GE(first.outbound().used, first.outbound().room) << "it is full";
    EXPECT_EQ(second.outbound().used, 0U) << "the other way";
    MessageBuffer buffer;
    while (second.receive(buffer).value().flow == Flow::New) {}
    EXPECT_EQ(first.outbound().used, 0U);
  }
  EXPECT_GT(taken[1], 3 * taken[0]);
}

TEST(SocketChannelOfASize, IsRefusedWhereTheSystemGrantsLessThanIsAsked) {
  constexpr std::uint32_t gigabyte_kb = 1U << 20;
  const auto refused = SocketChannel::make_pair(gigabyte_kb);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
}

TEST(SealedMemory, DoesNotMapWhatCouldShrinkUnderIt) {
  const MemoryHandle handle = SealedMemory::adopt(::memfd_create("open", MFD_ALLOW_SEALING | MFD_CLOEXEC));
  ASSERT_EQ(::ftruncate(SealedMemory::descriptor(handle), 64), 0);
  EXPECT_EQ(SealedMemory{}.map(handle, Access::ReadOnly).error().code, ErrorCode::Mismatch);
  EXPECT_EQ(SealedMemory{}.verify(handle, 64, false).error().code, ErrorCode::Mismatch);
}

/// A peer that follows no rule, on the raw socket.
class SocketChannelAbuse : public ::testing::Test {
 protected:
  SocketChannelAbuse() {
    auto ends = SocketChannel::make_pair().value();
    peer_ = std::move(ends.first);
    channel_.emplace(std::move(ends.second));
  }
  void send_raw(Octets octets, int descriptors = 0) {
    iovec part{const_cast<std::byte*>(octets.data()), octets.size()};
    msghdr header{};
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(16 * sizeof(int))> control{};
    if (descriptors > 0) {
      header.msg_control = control.data();
      header.msg_controllen = CMSG_SPACE(static_cast<std::size_t>(descriptors) * sizeof(int));
      cmsghdr* const rights = CMSG_FIRSTHDR(&header);
      rights->cmsg_level = SOL_SOCKET;
      rights->cmsg_type = SCM_RIGHTS;
      rights->cmsg_len = CMSG_LEN(static_cast<std::size_t>(descriptors) * sizeof(int));
      const int number = peer_.get();
      for (int i = 0; i < descriptors; ++i)
        std::memcpy(CMSG_DATA(rights) + static_cast<std::size_t>(i) * sizeof number, &number, sizeof number);
    }
    ASSERT_GE(::sendmsg(peer_.get(), &header, MSG_NOSIGNAL), 0);
  }
  static std::ptrdiff_t open_descriptors() {
    return std::distance(std::filesystem::directory_iterator{"/proc/self/fd"}, std::filesystem::directory_iterator{});
  }
  ErrorCode refusal() {
    const auto found = channel_->receive(buffer_);
    EXPECT_FALSE(found);
    return found ? ErrorCode::Internal : found.error().code;
  }

  FileDescriptor peer_;
  std::optional<SocketChannel> channel_;
  MessageBuffer buffer_{};
  static constexpr std::array good{std::byte{1},   std::byte{envelope::version},
                                   std::byte{0},   std::byte{0},
                                   std::byte{0},   std::byte{0},
                                   std::byte{0},   std::byte{5},
                                   std::byte{0xAA}};
};

/// Both ways to read, of what differs between them.
TEST_F(SocketChannelAbuse, WhoTakesNoMemoryReadsThePacketsOfAPeerThatSendsAnyAndKeepsNoDescriptor) {
  auto ends = SocketChannel::make_pair().value();
  peer_ = std::move(ends.first);
  SocketChannel taking_none{std::move(ends.second), SocketChannel::Memory::Dropped};
  const auto before = open_descriptors();
  for (const int descriptors : {0, 1, 3, 16}) {
    send_raw(good, descriptors);
    const auto found = taking_none.receive(buffer_);
    ASSERT_TRUE(found) << descriptors;
    EXPECT_EQ(found->message.epoch, 5u);
    EXPECT_TRUE(std::ranges::equal(found->message.packet, std::array{std::byte{0xAA}}));
    EXPECT_FALSE(found->message.memory);
  }
  EXPECT_EQ(open_descriptors(), before);
  const std::vector<std::byte> too_long(envelope::octets + max_packet_octets + 1, std::byte{1});
  send_raw(too_long);
  EXPECT_EQ(taking_none.receive(buffer_).error().code, ErrorCode::Malformed);
  EXPECT_EQ(taking_none.receive(buffer_).value().flow, Flow::None) << "it is gone";
}

TEST_F(SocketChannelAbuse, EnvelopeIsBigEndianAndEightOctetsLong) {
  send_raw(good);
  const auto found = channel_->receive(buffer_).value();
  EXPECT_EQ(found.message.epoch, 5u);
  ASSERT_EQ(found.message.packet.size(), 1u);
  EXPECT_EQ(found.message.packet[0], std::byte{0xAA});
}

TEST_F(SocketChannelAbuse, IsRefusedAndTheNextMessageIsRead) {
  send_raw({});
  send_raw(Octets{good}.first(7));
  auto kind = good;
  kind[0] = std::byte{0};
  send_raw(kind);
  send_raw(std::vector<std::byte>(envelope::octets + max_packet_octets + 1, std::byte{1}));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(refusal(), ErrorCode::Malformed) << i;
  send_raw(good);
  EXPECT_EQ(channel_->receive(buffer_).value().flow, Flow::New);
}

TEST_F(SocketChannelAbuse, OfAnotherVersionIsRefusedAndTheNextMessageIsRead) {
  EXPECT_EQ(channel_->foreign_version(), std::nullopt);
  for (const std::uint8_t version : {std::uint8_t{0}, std::uint8_t{envelope::version + 1}}) {
    auto other = good;
    other[1] = std::byte{version};
    send_raw(other);
    EXPECT_EQ(refusal(), ErrorCode::Mismatch) << int{version};
    EXPECT_EQ(channel_->foreign_version(), version);
  }
  send_raw(good);
  EXPECT_EQ(channel_->receive(buffer_).value().flow, Flow::New);
}

TEST_F(SocketChannelAbuse, LeavesNoDescriptorBehind) {
  const std::ptrdiff_t before = open_descriptors();
  for (const int count : {2, 4, 5, 16}) {
    send_raw(good, count);
    EXPECT_EQ(refusal(), ErrorCode::Malformed) << count;
  }
  send_raw(Octets{good}.first(3), 1);
  EXPECT_EQ(refusal(), ErrorCode::Malformed);
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(SocketChannelAbuse, ReceivedDescriptorsAreClosedOnExec) {
  send_raw(good, 1);
  const auto found = channel_->receive(buffer_).value();
  EXPECT_NE(::fcntl(SealedMemory::descriptor(found.message.memory), F_GETFD) & FD_CLOEXEC, 0);
}

}  // namespace
}  // namespace hirosco::testing
