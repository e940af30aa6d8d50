// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/communication/tcp_server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <numeric>
#include <random>

/// A server on the loopback address, its clients, and somebody who answers them.
namespace hirosco::communication::testing {

inline std::vector<std::byte> telecommand(std::uint16_t count = 0, std::size_t data_octets = 0) {
  std::vector<std::byte> buffer(pus::max_telecommand_octets);
  const std::vector<std::byte> data(data_octets, std::byte{0x5A});
  const auto packet =
      pus::write_telecommand(buffer, {.apid = 11, .sequence_count = count, .service = 17, .subtype = 1}, data);
  return {packet->begin(), packet->end()};
}

/// Answers each valid telecommand with one telemetry packet that carries its count.
struct Echo final : GroundTraffic {
  Taken telecommand(ClientId, Octets packet, Said when) override {
    if (room == 0) return Taken::Later;
    --room;
    ++packets;
    said.push_back(when);
    const auto view = pus::TelecommandView::parse(packet);
    if (!view) return Taken::Yes;
    ++valid;
    std::array<std::byte, 64> buffer{};
    const auto answer = pus::write_telemetry(
        buffer, {.apid = 11, .sequence_count = view->sequence_count(), .service = 17, .subtype = 2}, {});
    if (server != nullptr && answer) static_cast<void>(server->telemetry(*answer));
    return Taken::Yes;
  }
  TcpServer* server{nullptr};
  std::uint64_t packets{0};
  std::vector<Said> said;
  std::uint64_t valid{0};
  std::uint64_t room{~std::uint64_t{0}};  ///< packets that it takes; then all has to wait
};

/// A client on a real socket, non-blocking.
class Client {
 public:
  explicit Client(std::uint16_t port) : socket_{::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    const int code = ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
    EXPECT_TRUE(code == 0 || errno == EINPROGRESS) << errno;
  }
  /// Sends as much as goes; how much that was.
  std::size_t send(Octets octets) {
    const ssize_t count = ::send(socket_.get(), octets.data(), octets.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    return count < 0 ? 0 : static_cast<std::size_t>(count);
  }
  /// Reads what is there.
  void receive() {
    std::array<std::byte, 65'536> buffer;
    for (;;) {
      const ssize_t count = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
      if (count > 0) {
        received.insert(received.end(), buffer.begin(), buffer.begin() + count);
        continue;
      }
      closed = closed || count == 0 || (errno != EAGAIN && errno != EINTR);
      return;
    }
  }
  void end_sending() { ::shutdown(socket_.get(), SHUT_WR); }
  void reset() {
    const linger now{.l_onoff = 1, .l_linger = 0};
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_LINGER, &now, sizeof now);
    socket_.reset();
  }
  [[nodiscard]] bool connected() const {
    pollfd wanted{.fd = socket_.get(), .events = POLLOUT, .revents = 0};
    return ::poll(&wanted, 1, 0) == 1 && (wanted.revents & POLLOUT) != 0;
  }

  std::vector<std::byte> received;
  bool closed{false};

 private:
  FileDescriptor socket_;
};

class TcpServerTest : public ::testing::Test {
 protected:
  void SetUp() override { start({}); }
  void start(const GroundClients::Limits& limits) {
    server_.reset();
    server_ = std::move(*TcpServer::open({.telemetry_port = 0, .telecommand_port = 0, .limits = limits}, echo_));
    echo_.server = server_.get();
  }
  /// Steps the server until `done`; a test that cannot get there is ended by the time limit of the test runner.
  template <class Done>
  void until(Done done) {
    while (!done()) next_ = server_->step(now_);
  }
  [[nodiscard]] std::uint16_t port(GroundPort port = GroundPort::TelemetryAndTelecommands) const {
    return server_->port(port);
  }
  void until_connected(std::uint64_t clients) {
    until([&] { return server_->counters().clients == clients; });
  }
  /// An honest client pings and gets its answer.
  void expect_service() {
    Client honest{port()};
    expect_service(honest);
  }
  void expect_service(Client& honest) {
    const auto count = static_cast<std::uint16_t>(++pings_ & 0x3FFF);
    honest.received.clear();
    until([&] { return honest.connected(); });
    ASSERT_EQ(honest.send(telecommand(count)), 13U);
    until([&] {
      honest.receive();
      return honest.closed || last_answer(honest) == count;   // it hears the answers to others as well
    });
    ASSERT_FALSE(honest.closed);
  }
  /// Count of the last whole answer, -1 before the first.
  static int last_answer(const Client& client) {
    const std::size_t whole = client.received.size() / 22 * 22;
    if (whole == 0) return -1;
    const auto answer = pus::TelemetryView::parse(Octets{client.received}.subspan(whole - 22, 22));
    return answer ? answer->sequence_count() : -1;
  }
  [[nodiscard]] std::uint64_t closed(CloseReason reason) const {
    return server_->counters().closed[static_cast<std::size_t>(reason)];
  }

  Echo echo_;
  std::unique_ptr<TcpServer> server_;
  TimePoint now_{1s};
  std::optional<TimePoint> next_;
  unsigned pings_{0};
};

}  // namespace hirosco::communication::testing
