// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/testing/slice.hpp"
#include "subsystems/communication/testing/tcp_rig.hpp"

namespace hirosco::communication {
namespace {

using namespace testing;

TEST_F(TcpServerTest, RefusesEveryAddressButLoopback) {
  for (const char* address : {"0.0.0.0", "192.168.1.1", "8.8.8.8", "128.0.0.1"})
    EXPECT_EQ(TcpServer::open({.address = address, .telemetry_port = 0, .telecommand_port = 0}, echo_).error().code,
              ErrorCode::NotPermitted)
        << address;
  EXPECT_FALSE(TcpServer::open({.address = "localhost", .telemetry_port = 0, .telecommand_port = 0}, echo_));
  EXPECT_TRUE(TcpServer::open({.address = "127.0.0.2", .telemetry_port = 0, .telecommand_port = 0}, echo_));
}

TEST_F(TcpServerTest, ListensWhereItIsToldByAddresses) {
  const auto options = TcpServer::at("127.0.0.3:31015", "127.0.0.2:31025");
  ASSERT_TRUE(options);
  EXPECT_EQ(options->address, "127.0.0.3");
  EXPECT_EQ(options->telemetry_port, 31015);
  EXPECT_EQ(options->telecommand_address, "127.0.0.2");
  EXPECT_EQ(options->telecommand_port, 31025);
  EXPECT_EQ(TcpServer::at("", "")->telemetry_port, 10015) << "nobody says";
  for (const char* address : {"127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:70000", ":10015", "127.0.0.1:1 "})
    EXPECT_FALSE(TcpServer::at(address, "")) << address;
}

TEST_F(TcpServerTest, ListensForTelecommandsAtAnotherAddressThanForTelemetry) {
  Echo echo;
  auto server =
      TcpServer::open(
          {.address = "127.0.0.3", .telecommand_address = "127.0.0.2", .telemetry_port = 0, .telecommand_port = 0},
          echo)
          .value();
  const auto connects = [&](const char* host, GroundPort port) {
    const FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(server->port(port));
    ::inet_pton(AF_INET, host, &address.sin_addr);
    return ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  };
  EXPECT_TRUE(connects("127.0.0.3", GroundPort::TelemetryAndTelecommands));
  EXPECT_TRUE(connects("127.0.0.2", GroundPort::TelecommandsOnly));
  EXPECT_FALSE(connects("127.0.0.3", GroundPort::TelecommandsOnly));
}

TEST_F(TcpServerTest, ReportsAPortThatIsTaken) {
  const auto second = TcpServer::open({.telemetry_port = port(), .telecommand_port = 0}, echo_);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().value, EADDRINUSE);
}

TEST_F(TcpServerTest, AnswersOnTheTelemetryPortAndOnlyListensOnTheOther) {
  Client commander{port(GroundPort::TelecommandsOnly)};
  Client listener{port()};
  until_connected(2);
  commander.send(telecommand(7));
  until([&] {
    listener.receive();
    return listener.received.size() == 22;
  });
  commander.receive();
  EXPECT_TRUE(commander.received.empty());
  EXPECT_FALSE(commander.closed);
}

TEST_F(TcpServerTest, WakesItsOwnerByItsDescriptor) {
  const auto readable = [&] {
    pollfd wanted{.fd = server_->descriptor(), .events = POLLIN, .revents = 0};
    return ::poll(&wanted, 1, 0) == 1;
  };
  server_->step(now_);
  EXPECT_FALSE(readable());
  Client client{port()};
  while (!readable()) {}
  until_connected(1);
  EXPECT_FALSE(readable());
  client.send(telecommand());
  while (!readable()) {}
  until([&] { return echo_.valid == 1; });
}

TEST_F(TcpServerTest, TakesATelecommandOctetByOctet) {
  Client client{port()};
  until_connected(1);
  const auto packet = telecommand(3, 50);
  for (const std::byte& octet : packet) {
    ASSERT_EQ(client.send({&octet, 1}), 1U);
    const std::uint64_t before = server_->clients().counters().packets;
    server_->step(now_);
    ASSERT_TRUE(&octet == &packet.back() || before == 0);
  }
  until([&] { return echo_.valid == 1; });
}

TEST_F(TcpServerTest, ClosesExactlyTheConnectionsWithAnImplausibleLength) {
  Client honest{port()};
  expect_service(honest);
  Client plausible{port()};   // one connection for all lengths that may come
  until_connected(2);
  std::vector<std::byte> stream;
  std::uint64_t whole = 0;
  std::uint64_t spoilt = 0;
  for (std::size_t field = 0; field <= 0xFFFF; field += hirosco::testing::one_in(std::size_t{15})) {
    std::vector<std::byte> packet = telecommand();
    packet[4] = static_cast<std::byte>(field >> 8);
    packet[5] = static_cast<std::byte>(field);
    const std::size_t total = field + 7;
    if (total >= 13 && total <= 4096) {
      packet.resize(total);
      ++whole;
      for (Octets rest{packet}; !rest.empty(); server_->step(now_)) rest = rest.subspan(plausible.send(rest));
      continue;
    }
    Client attacker{port()};
    until([&] { return attacker.connected(); });
    ASSERT_EQ(attacker.send(packet), packet.size());
    ++spoilt;
    until([&] { return closed(CloseReason::Length) == spoilt; });
    attacker.reset();
    if (field % 1000 == 0) expect_service(honest);
  }
  until([&] { return echo_.packets == whole + pings_; });
  EXPECT_EQ(closed(CloseReason::Length), spoilt);
  EXPECT_EQ(spoilt + whole, 65'535U / hirosco::testing::one_in(std::size_t{15}) + 1);
  EXPECT_EQ(server_->counters().clients, 2U);
  expect_service(honest);
}

TEST_F(TcpServerTest, ExecutesNoTelecommandWithAFlippedBit) {
  const auto good = telecommand(9, 4);
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    auto damaged = good;
    damaged[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
    Client client{port(GroundPort::TelecommandsOnly)};
    until([&] { return client.connected(); });
    ASSERT_EQ(client.send(damaged), damaged.size());
    client.end_sending();
    until([&] { return server_->counters().admitted == bit + 1 && server_->counters().clients == 0; });
  }
  EXPECT_EQ(echo_.valid, 0U);
  // Each of them is in a counter: handed on as a damaged one, idle, or the reason for which its connection ended. One
  // whose length shrank is in two: what is left of it is the beginning of no other.
  const LinkCounters& counters = server_->counters();
  std::uint64_t accounted = counters.packets + counters.idle_packets;
  for (const auto reason :
       {CloseReason::Version, CloseReason::NotTelecommand, CloseReason::Length, CloseReason::Incomplete})
    accounted += closed(reason);
  std::uint64_t expected = good.size() * 8;
  for (std::size_t bit = 4 * 8; bit < 6 * 8; ++bit) {
    auto damaged = good;
    damaged[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
    const std::size_t announced = pus::announced_octets(damaged);
    if (announced < good.size() && announced >= pus::telecommand_overhead_octets) ++expected;
  }
  EXPECT_EQ(accounted, expected);
  EXPECT_EQ(std::accumulate(counters.closed.begin(), counters.closed.end(), std::uint64_t{0}), counters.admitted);
  expect_service();
}

}  // namespace
}  // namespace hirosco::communication
