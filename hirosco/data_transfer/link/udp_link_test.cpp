// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/link/udp_link.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <memory>
#include <random>
#include <vector>

#include "hirosco/data_transfer/address/internet_address.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {
namespace {

using UdpPayload = std::array<std::byte, 64>;

/// A socket of nobody's, at a port of 127.0.0.1.
class StrangeSocket {
 public:
  StrangeSocket() {
    EXPECT_EQ(::bind(socket_.get(), at(0).get(), sizeof(sockaddr_in)), 0);
    sockaddr_in own{};
    socklen_t octets = sizeof own;
    EXPECT_EQ(::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&own), &octets), 0);
    port_ = ntohs(own.sin_port);
  }
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  void send(Octets octets, const std::string& to) {
    const auto there = at(read_internet_address(to).value().port);
    EXPECT_EQ(::sendto(socket_.get(), octets.data(), octets.size(), MSG_DONTWAIT, there.get(), sizeof(sockaddr_in)),
              static_cast<ssize_t>(octets.size()));
  }
  /// Empty: nothing waits.
  std::vector<std::byte> receive() {
    std::vector<std::byte> octets(65'536);
    const ssize_t got = ::recv(socket_.get(), octets.data(), octets.size(), MSG_DONTWAIT);
    octets.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
    return octets;
  }

 private:
  struct At {
    sockaddr_in place{};
    const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&place); }
  };
  static At at(std::uint16_t port) {
    At made;
    made.place.sin_family = AF_INET;
    made.place.sin_port = htons(port);
    made.place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return made;
  }
  FileDescriptor socket_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  std::uint16_t port_{0};
};

class UdpLinkTest : public ::testing::Test {
 protected:
  LinkLayout declared(const std::string& at = "127.0.0.1", std::uint32_t octets = sizeof(UdpPayload)) const {
    return {.epoch = 4,
            .payload_octets = octets,
            .layout_hash = 5,
            .period = 1ms,
            .route = {.link = 6, .producer = at, .consumer = at, .key = 0}};
  }
  void make(const LinkLayout& layout) {
    layout_ = layout;
    made_ = udp_.produce(memory_, {}, layout).value();
    writer_ = dynamic_cast<UdpWriter*>(made_.get());
    layout_.route.producer = writer_->route().producer;
    layout_.route.key = writer_->route().key;
    heard_ = udp_.consume(memory_, {}, layout_).value();
    reader_ = dynamic_cast<UdpReader*>(heard_.get());
    ASSERT_TRUE(writer_->reach(reader_->route().consumer));
  }
  static UdpPayload sample(std::uint64_t number) {
    UdpPayload payload{};
    payload.fill(static_cast<std::byte>(number));
    return payload;
  }
  void write(std::uint64_t number) { writer_->write(sample(number), TimePoint{}, LinkStatus::Valid); }
  LinkSample read() { return reader_->read(seen_); }

  HeapMemory memory_;
  UdpLink udp_;
  LinkLayout layout_;
  std::unique_ptr<LinkWriter> made_;
  std::unique_ptr<LinkReader> heard_;
  UdpWriter* writer_{nullptr};
  UdpReader* reader_{nullptr};
  UdpPayload seen_{};
};

TEST_F(UdpLinkTest, GoesByIpv6AsWell) {
  make(declared("::1"));
  write(1);
  EXPECT_EQ(read().count, 1u);
  EXPECT_TRUE(writer_->route().producer.starts_with("[::1]:"));
}

TEST_F(UdpLinkTest, StandsAtThePortThatTheMissionGives) {
  std::string port;
  {
    const StrangeSocket finds;
    port = finds.address();
  }
  LinkLayout fixed = declared();
  fixed.route.consumer = port;
  make(fixed);
  EXPECT_EQ(reader_->route().consumer, port);
  const auto second = udp_.consume(memory_, {}, layout_);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::Unavailable) << "the port is taken";
}

TEST_F(UdpLinkTest, AnAddressOfAnotherComputerIsNoPlaceToStand) {
  EXPECT_EQ(udp_.produce(memory_, {}, declared("192.0.2.7")).error().code, ErrorCode::Unavailable);
  EXPECT_FALSE(udp_.produce(memory_, {}, declared("")));
  LinkLayout mixed = declared("::1");
  mixed.route.producer = "127.0.0.1:4000";
  EXPECT_EQ(udp_.consume(memory_, {}, mixed).error().code, ErrorCode::Mismatch);
}

TEST_F(UdpLinkTest, NothingIsSentBeforeItsConsumerStands) {
  layout_ = declared();
  made_ = udp_.produce(memory_, {}, layout_).value();
  made_->write(sample(1), TimePoint{}, LinkStatus::Valid);
  EXPECT_EQ(dynamic_cast<UdpWriter&>(*made_).unsent(), 0u);
  EXPECT_FALSE(made_->reach("127.0.0.1")) << "no port";
  EXPECT_FALSE(made_->reach("[::1]:4000"));
  EXPECT_FALSE(made_->reach("nowhere"));
}

TEST_F(UdpLinkTest, ASampleThatDoesNotFitTheWayWholeIsRefusedAndNotCut) {
  // 65,536 octets are the MTU of the loopback of Linux: 40 + 8 of them are heads.
  const std::uint32_t fits = 65'536 - 48 - link_datagram::extra_octets;
  for (const std::uint32_t octets : {fits, fits + 1}) {
    LinkLayout large = declared("::1", octets);
    const auto writer = udp_.produce(memory_, {}, large).value();
    large.route.producer = writer->route().producer;
    const auto reader = udp_.consume(memory_, {}, large);
    ASSERT_TRUE(reader);
    EXPECT_EQ(writer->reach((*reader)->route().consumer).has_value(), octets == fits);
  }
}

TEST_F(UdpLinkTest, ALargeSampleComesWhole) {
  LinkLayout large = declared("127.0.0.1", max_datagram_payload_octets);
  make(large);
  std::vector<std::byte> payload(max_datagram_payload_octets), seen(payload.size());
  for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::byte>(i * 7);
  for (int round = 0; round < 3; ++round) {
    writer_->write(payload, TimePoint{}, LinkStatus::Valid);
    EXPECT_EQ(reader_->read(seen).flow, Flow::New);
    EXPECT_EQ(seen, payload);
  }
}

TEST_F(UdpLinkTest, AConsumerThatIsGoneIsCountedAndNothingElse) {
  make(declared());
  heard_.reset();
  for (std::uint64_t number = 1; number <= 100; ++number) write(number);
  EXPECT_GT(writer_->unsent(), 0u);
  EXPECT_LE(writer_->unsent(), 100u);
}

TEST_F(UdpLinkTest, WhoWasAwayForLongIsNotGivenThePastForFresh) {
  make(declared());
  write(1);
  ASSERT_EQ(read().count, 1u);
  for (std::uint64_t number = 2; number <= 3000; ++number) write(number);
  const LinkSample first = read();
  EXPECT_EQ(first.flow, Flow::Old) << "what waits is from the beginning of the pause";
  EXPECT_EQ(seen_, sample(1));
  write(3001);
  const LinkSample next = read();
  EXPECT_EQ(next.flow, Flow::New);
  EXPECT_EQ(next.count, 3001u);
  EXPECT_EQ(next.lost, 2999u);
}

TEST_F(UdpLinkTest, AShortPauseCostsTheSamplesBetweenAndNotTheNewest) {
  make(declared());
  for (std::uint64_t number = 1; number <= 5; ++number) write(number);
  EXPECT_EQ(read().count, 5u);
  EXPECT_EQ(seen_, sample(5));
}

TEST_F(UdpLinkTest, TheEndIsToldSoThatOneLossDoesNotHideIt) {
  StrangeSocket wire;
  made_ = udp_.produce(memory_, {}, declared()).value();
  ASSERT_TRUE(made_->reach(wire.address()));
  made_->write(sample(1), TimePoint{}, LinkStatus::Valid);
  made_->set_status(LinkStatus::Stopping);
  int told = 0;
  for (auto octets = wire.receive(); !octets.empty(); octets = wire.receive())
    told += octets[7] == static_cast<std::byte>(LinkStatus::Stopping) ? 1 : 0;
  EXPECT_GE(told, 3);
}

TEST_F(UdpLinkTest, AStrangersDatagramsNeitherCountNorTakeRoom) {
  make(declared());
  StrangeSocket stranger;
  std::vector<std::byte> forged(link_datagram_octets(layout_.payload_octets));
  write_link_datagram(forged, layout_, {LinkStatus::Valid, 900, 900, TimePoint{}}, sample(9));
  for (int i = 0; i < 500; ++i) stranger.send(forged, reader_->route().consumer);
  write(1);
  EXPECT_EQ(read().count, 1u) << "though the stranger knew the key and filled what there was";
  const DatagramRefusals& refusals = reader_->refusals();
  EXPECT_EQ(refusals.damaged + refusals.foreign + refusals.late, 0u) << "the system kept them out";
}

/// A wire of its own between both ends, which loses, doubles, delays and damages by a seed.
TEST_F(UdpLinkTest, OverABadWireSamplesComeWholeOnceAndForwardAndEachIsAccountedFor) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    std::mt19937 draw{seed};
    StrangeSocket wire;
    LinkLayout layout = declared();
    made_ = udp_.produce(memory_, {}, layout).value();
    layout.route.key = made_->route().key;
    layout.route.producer = wire.address();
    const auto reader = udp_.consume(memory_, {}, layout).value();
    ASSERT_TRUE(made_->reach(wire.address()));
    std::vector<std::vector<std::byte>> held;
    std::uint64_t last = 0, taken = 0, lost = 0, first = 0;
    for (std::uint64_t number = 1; number <= 4000; ++number) {
      made_->write(sample(number), TimePoint{}, LinkStatus::Valid);
      auto octets = wire.receive();
      ASSERT_FALSE(octets.empty());
      if (draw() % 10 != 0) held.push_back(octets);
      if (draw() % 10 == 0) held.push_back(octets);
      if (draw() % 10 == 0) octets[draw() % octets.size()] ^= std::byte{0x10}, held.push_back(octets);
      while (held.size() > draw() % 4) {
        const auto which = static_cast<std::ptrdiff_t>(draw() % held.size());
        wire.send(held[static_cast<std::size_t>(which)], reader->route().consumer);
        held.erase(held.begin() + which);
      }
      const LinkSample found = reader->read(seen_);
      if (found.flow != Flow::New) continue;
      ASSERT_GT(found.count, last);
      ASSERT_LE(found.count, number);
      ASSERT_EQ(seen_, sample(found.count));
      if (last == 0) first = found.count;
      last = found.count;
      lost += found.lost;
      ++taken;
    }
    EXPECT_EQ(lost + taken, last - first + 1);
    EXPECT_GT(taken, 2000u);
    EXPECT_GT(dynamic_cast<UdpReader&>(*reader).refusals().late, 100u);
    EXPECT_GT(dynamic_cast<UdpReader&>(*reader).refusals().damaged, 100u);
  }
}

}  // namespace
}  // namespace hirosco
