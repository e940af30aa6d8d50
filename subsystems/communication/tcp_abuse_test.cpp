// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/testing/tcp_rig.hpp"

namespace hirosco::communication {
namespace {

using namespace testing;

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
