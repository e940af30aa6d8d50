// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/tcp_flow.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>
#include <thread>
#include <vector>

#include "hirosco/data_transfer/device/testing/streamed.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {
namespace {

using testing::streamed;

/// A listener or a client of the test's own, beside the flow.
struct Wire {
  FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  sockaddr_in at{};
  Wire() {
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  /// At a port that the system chooses.
  void listen() {
    socklen_t octets = sizeof at;
    ASSERT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&at), octets), 0);
    ASSERT_EQ(::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&at), &octets), 0);
    ASSERT_EQ(::listen(socket.get(), 100), 0);
  }
  [[nodiscard]] std::string address() const { return "127.0.0.1:" + std::to_string(ntohs(at.sin_port)); }
  [[nodiscard]] bool connect(const std::string& address) {
    at.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.find(':') + 1))));
    return ::connect(socket.get(), reinterpret_cast<sockaddr*>(&at), sizeof at) == 0;
  }
  void put(Octets octets) const {
    ASSERT_EQ(::send(socket.get(), octets.data(), octets.size(), 0), static_cast<ssize_t>(octets.size()));
  }
};

std::string free_address() {
  Wire wire;
  wire.listen();
  return wire.address();
}

struct TcpFlow : ::testing::Test {
  std::array<std::byte, max_frame_octets> buffer{};
  /// The mark of the frame that came; -1: none, -2: hang-up.
  int receive(DataFlow& flow) {
    const auto received = flow.receive(buffer);
    if (!received) return -2;
    return received->flow == Flow::New ? std::to_integer<int>(buffer[0]) : -1;
  }
};

TEST_F(TcpFlow, AFrameInPiecesIsWholeOrNotThere) {
  const std::string address = free_address();
  const auto device = open_tcp_flow({.address = address, .side = FlowSide::Device}).value();
  Wire peer;
  ASSERT_TRUE(peer.connect(address));
  const auto frame = streamed(7);
  peer.put(Octets{frame}.first(11));
  ASSERT_TRUE(device->wait(1h));
  EXPECT_EQ(receive(*device), -1);
  peer.put(Octets{frame}.subspan(11));
  ASSERT_TRUE(device->wait(1h));
  EXPECT_EQ(receive(*device), 7);
}

TEST_F(TcpFlow, WhatAConnectionThatBrokeHadBegunIsNoPartOfTheNextOne) {
  const std::string address = free_address();
  const auto device = open_tcp_flow({.address = address, .side = FlowSide::Device}).value();
  {
    Wire peer;
    ASSERT_TRUE(peer.connect(address));
    peer.put(Octets{streamed(7)}.first(30));
    ASSERT_TRUE(device->wait(1h));
    EXPECT_EQ(receive(*device), -1);
  }
  Wire peer;
  ASSERT_TRUE(peer.connect(address));
  peer.put(streamed(8));
  while (receive(*device) != 8) ASSERT_TRUE(device->wait(1h));
  EXPECT_EQ(device->receive(buffer).value().damaged, 0U);
}

TEST_F(TcpFlow, WhoConnectedLastIsSpokenWith) {
  const std::string address = free_address();
  const auto device = open_tcp_flow({.address = address, .side = FlowSide::Device}).value();
  Wire half_dead, living;
  ASSERT_TRUE(half_dead.connect(address));
  half_dead.put(streamed(1));
  while (receive(*device) != 1) ASSERT_TRUE(device->wait(1h));
  ASSERT_TRUE(living.connect(address));
  living.put(streamed(2));
  while (receive(*device) != 2) ASSERT_TRUE(device->wait(1h));
  ASSERT_TRUE(device->send(std::vector<std::byte>(3, std::byte{9})));
  std::array<std::byte, 64> got{};
  EXPECT_EQ(::recv(living.socket.get(), got.data(), got.size(), 0), 3 + static_cast<ssize_t>(stream_overhead_octets));
}

TEST_F(TcpFlow, DamageIsCountedAndTheNextFrameComes) {
  const std::string address = free_address();
  const auto device = open_tcp_flow({.address = address, .side = FlowSide::Device}).value();
  Wire peer;
  ASSERT_TRUE(peer.connect(address));
  auto damaged = streamed(1);
  damaged[20] ^= std::byte{1};
  peer.put(damaged);
  ASSERT_TRUE(device->wait(1h));
  const auto nothing = device->receive(buffer).value();
  EXPECT_EQ(nothing.flow, Flow::None);
  EXPECT_EQ(nothing.damaged, 1U);
  peer.put(streamed(2));
  ASSERT_TRUE(device->wait(1h));
  EXPECT_EQ(receive(*device), 2);
}

/// A listener that lets go of everybody at once: whoever asks in a tight loop would connect some ten thousand times in a second.
TEST_F(TcpFlow, ConnectsAgainNoMoreOftenThanItsPause) {
  Wire listener;
  listener.listen();
  const SystemClock clock;
  const TimePoint begin = clock.now();
  const auto subsystem = open_tcp_flow({.address = listener.address()}).value();
  std::thread lets_go{[&] {
    for (;;) {
      const FileDescriptor one{::accept4(listener.socket.get(), nullptr, nullptr, SOCK_CLOEXEC)};
      if (!one) return;
    }
  }};
  int hung_up = 0;
  bool before = false;
  const TimePoint end = begin + 10 * reconnect_pause;
  std::uint64_t calls = 0;
  while (clock.now() < end) {
    const bool now = !subsystem->receive(buffer);
    if (now && !before) ++hung_up;
    before = now;
    ++calls;
  }
  const auto most = (clock.now() - begin) / reconnect_pause + 1;
  EXPECT_GE(hung_up, 1);
  EXPECT_LE(hung_up, most);
  EXPECT_GT(calls, 100U);
  ::shutdown(listener.socket.get(), SHUT_RDWR);
  lets_go.join();
}

TEST_F(TcpFlow, WhatNobodyReadsIsLetGoWholeAndOldFramesDoNotPileUp) {
  const std::string address = free_address();
  const auto device = open_tcp_flow({.address = address, .side = FlowSide::Device}).value();
  const auto subsystem = open_tcp_flow({.address = address}).value();
  while (!subsystem->send(std::array{std::byte{1}})) ASSERT_FALSE(device->wait(0ns));
  while (receive(*device) != 1) ASSERT_TRUE(device->wait(1h));
  // As long as its system takes them, and no longer: never half of one.
  const std::vector<std::byte> long_frame(max_frame_octets, std::byte{5});
  int let_go = 0;
  for (int i = 0; i < 100'000 && let_go < 100; ++i) let_go += subsystem->send(long_frame) ? 0 : 1;
  EXPECT_EQ(let_go, 100);
  int frames = 0, mark = 0;
  while (mark != 6) {
    const auto received = device->receive(buffer);
    ASSERT_TRUE(received);
    EXPECT_EQ(received->damaged, 0U);
    mark = received->flow == Flow::New ? std::to_integer<int>(buffer[0]) : mark;
    frames += received->flow == Flow::New ? 1 : 0;
    (void)subsystem->send(std::array{std::byte{6}});
  }
  EXPECT_GT(frames, 1);
}

TEST_F(TcpFlow, IsNotConnectedWithItself) {
  // The port of nobody, again and again: sooner or later the system chooses it for the end that looks for it.
  const std::string address = free_address();
  const auto subsystem = open_tcp_flow({.address = address}).value();
  for (int i = 0; i < 1000; ++i) {
    ASSERT_FALSE(subsystem->send(std::array{std::byte{1}}));
    ASSERT_EQ(subsystem->receive(buffer).value().flow, Flow::None);
  }
}

}  // namespace
}  // namespace hirosco
