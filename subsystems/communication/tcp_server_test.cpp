// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
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

namespace hirosco::communication {
namespace {

std::vector<std::byte> telecommand(std::uint16_t count = 0, std::size_t data_octets = 0) {
  std::vector<std::byte> buffer(pus::max_telecommand_octets);
  const std::vector<std::byte> data(data_octets, std::byte{0x5A});
  const auto packet =
      pus::write_telecommand(buffer, {.apid = 11, .sequence_count = count, .service = 17, .subtype = 1}, data);
  return {packet->begin(), packet->end()};
}

/// Answers each valid telecommand with one telemetry packet that carries its count.
struct Echo final : GroundTraffic {
  Taken telecommand(ClientId, Octets packet) override {
    if (room == 0) return Taken::Later;
    --room;
    ++packets;
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

class TcpServerTest : public testing::Test {
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
  for (std::size_t field = 0; field <= 0xFFFF; ++field) {
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
  EXPECT_EQ(closed(CloseReason::Length), 65'536U - whole);
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

TEST_F(TcpServerTest, LosesNothingOfAFloodThatIsTakenHaltinglyFromClientsThatComeAndGo) {
  echo_.room = 0;
  constexpr std::uint64_t each = 3000;
  std::vector<std::byte> stream;
  for (std::uint16_t i = 0; i < each; ++i) {
    const auto packet = telecommand(i);
    stream.insert(stream.end(), packet.begin(), packet.end());
  }
  std::uint64_t sent = 0;
  for (int i = 0; i < 5; ++i) {
    Client client{port(GroundPort::TelecommandsOnly)};
    until([&] { return client.connected(); });
    for (Octets rest{stream}; !rest.empty(); server_->step(now_)) {
      rest = rest.subspan(client.send(rest));
      echo_.room = 5;
    }
    sent += each;
    if (i % 2 == 0) client.end_sending();
  }  // and gone, with most of it unread
  until([&] {
    echo_.room = 5;
    return server_->counters().clients == 0;
  });
  EXPECT_EQ(echo_.valid, sent);
  EXPECT_EQ(server_->counters().packets, sent);
  EXPECT_EQ(closed(CloseReason::PeerClosed), 5U);
}

TEST_F(TcpServerTest, DoesNotWakeItsOwnerForWhatHasToWait) {
  const auto readable = [&] {
    pollfd wanted{.fd = server_->descriptor(), .events = POLLIN, .revents = 0};
    return ::poll(&wanted, 1, 0) == 1;
  };
  Client client{port()};
  until_connected(1);
  echo_.room = 0;
  std::vector<std::byte> stream;
  for (std::uint16_t i = 0; i < 2000; ++i) {
    const auto packet = telecommand(i);
    stream.insert(stream.end(), packet.begin(), packet.end());
  }
  ASSERT_EQ(client.send(stream), stream.size());
  until([&] { return server_->counters().held_back > 0; });
  until([&] { return !readable(); });
  EXPECT_EQ(echo_.packets, 0U);
  echo_.room = ~std::uint64_t{0};
  until([&] { return echo_.valid == 2000; });
}

TEST_F(TcpServerTest, FinishesWithAllThatItHasReceivedAndItsListenersHearTheAnswers) {
  Client client{port()};
  until_connected(1);
  echo_.room = 0;
  std::vector<std::byte> stream;
  for (std::uint16_t i = 0; i < 20; ++i) {
    const auto packet = telecommand(i);
    stream.insert(stream.end(), packet.begin(), packet.end());
  }
  ASSERT_EQ(client.send(stream), stream.size());
  until([&] { return server_->counters().held_back > 0; });
  echo_.room = 5;
  EXPECT_EQ(server_->finish(now_), 15U);
  client.send(telecommand(99));
  EXPECT_EQ(server_->finish(now_), 15U) << "nobody takes them";
  echo_.room = ~std::uint64_t{0};
  EXPECT_EQ(server_->finish(now_), 0U);
  while (last_answer(client) != 19) {
    EXPECT_EQ(server_->finish(now_), 0U);
    client.receive();
  }
  EXPECT_EQ(echo_.valid, 20U) << "what came later was not read";
}

TEST_F(TcpServerTest, ServesHonestClientsBesideTwoHundredSilentOnes) {
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 200; ++i) {
    silent.push_back(std::make_unique<Client>(
        port(i % 2 == 0 ? GroundPort::TelemetryAndTelecommands : GroundPort::TelecommandsOnly)));
    server_->step(now_);
  }
  until_connected(200);
  for (int i = 0; i < 10; ++i) expect_service();
}

TEST_F(TcpServerTest, LetsHonestClientsInWhenSilentOnesHoldEveryPlace) {
  start({.clients = 20});
  Client honest{port()};
  expect_service(honest);
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 100; ++i) {
    silent.push_back(std::make_unique<Client>(port()));
    until([&] { return silent.back()->connected(); });
    server_->step(now_);
  }
  expect_service();
  expect_service(honest);
  EXPECT_GE(closed(CloseReason::Evicted), 80U);
}

TEST_F(TcpServerTest, CutsATrickleAfterTwoSecondsAndNamesThatTimeToItsOwner) {
  Client slow{port()};
  until_connected(1);
  const auto packet = telecommand();
  slow.send(Octets{packet}.first(8));
  until([&] { return next_.has_value(); });
  EXPECT_EQ(next_, now_ + 2s);
  now_ += 2s;
  until([&] {
    slow.receive();
    return slow.closed;
  });
  EXPECT_EQ(closed(CloseReason::Incomplete), 1U);
}

TEST_F(TcpServerTest, SurvivesNoise) {
  std::mt19937 random{11};
  Client honest{port()};
  expect_service(honest);
  for (int i = 0; i < 300; ++i) {
    Client noisy{port()};
    until([&] { return noisy.connected(); });
    std::vector<std::byte> noise(1 + random() % 9000);
    for (std::byte& octet : noise) octet = static_cast<std::byte>(random());
    if (i % 2 == 0) {  // deeper than the first octets
      noise[0] = std::byte{0x18};
      if (noise.size() > 5) noise[4] = static_cast<std::byte>(random() % 16);
    }
    noisy.send(noise);
    server_->step(now_);
    if (i % 3 == 0) noisy.reset();
    if (i % 50 == 0) expect_service(honest);
  }
  EXPECT_EQ(echo_.valid, pings_);
  expect_service(honest);
}

TEST_F(TcpServerTest, CutsAClientThatNeverReadsAndServesTheOthers) {
  start({.backlog_octets = 64 * 1024});
  Client deaf{port()};
  Client reader{port()};
  until_connected(2);
  const std::vector<std::byte> packet = telecommand(0, 4000);
  std::uint64_t sent = 0;
  until([&] {
    // Nothing beyond what the reader can follow.
    reader.receive();
    if (sent - reader.received.size() < 32 * 1024) {
      EXPECT_TRUE(server_->telemetry(packet));
      sent += packet.size();
    }
    return closed(CloseReason::Slow) == 1;
  });
  until([&] {
    reader.receive();
    return reader.received.size() == sent;
  });
  EXPECT_FALSE(reader.closed);
}

TEST_F(TcpServerTest, KeepsAListenerThatHasEndedItsOwnDirection) {
  Client listener{port()};
  until_connected(1);
  listener.end_sending();
  server_->step(now_);
  expect_service();
  until([&] {
    listener.receive();
    return listener.received.size() == 22;
  });
  listener.reset();
  until([&] {
    EXPECT_TRUE(server_->telemetry(telecommand()));
    return server_->counters().clients == 0;
  });
}

TEST_F(TcpServerTest, ForgetsClientsThatResetTheirConnection) {
  for (int i = 0; i < 500; ++i) {
    Client client{port(i % 2 == 0 ? GroundPort::TelemetryAndTelecommands : GroundPort::TelecommandsOnly)};
    client.send(telecommand());
    server_->step(now_);
    client.reset();
  }
  until([&] { return server_->counters().clients == 0; });
  expect_service();
}

TEST_F(TcpServerTest, StaysAliveWithoutFreeDescriptors) {
  Client honest{port()};
  expect_service(honest);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  Client knocking{port()};
  rlimit none = before;
  none.rlim_cur = static_cast<rlim_t>(FileDescriptor{::dup(0)}.get());  // the lowest free number: nothing above is left
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  until([&] {
    knocking.receive();
    return knocking.closed;
  });
  expect_service(honest);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  expect_service();
}

}  // namespace
}  // namespace hirosco::communication
