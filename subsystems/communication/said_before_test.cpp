// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/testing/tcp_rig.hpp"

/// What came before a stop of everything is offered as said before it, wherever it lies (docs/adr/0156).
namespace hirosco::communication {
namespace {

using namespace communication::testing;
using ::testing::ElementsAre;
using enum GroundTraffic::Said;

struct Listening final : GroundTraffic {
  Taken telecommand(ClientId, Octets, Said when) override {
    if (holds) return Taken::Later;
    said.push_back(when);
    return Taken::Yes;
  }
  std::vector<Said> said;
  bool holds{false};
};

class SaidBefore : public ::testing::Test {
 protected:
  void put(Octets octets) {
    std::ranges::copy(octets, clients_.room(client_).begin());
    clients_.received(client_, octets.size(), {});
  }
  void hand_over() { static_cast<void>(clients_.hand_over(taken_, {})); }

  GroundClients clients_{{}};
  ClientId client_{clients_.admit(GroundPort::TelecommandsOnly, {})->client};
  Listening taken_;
  std::vector<std::byte> packet_{telecommand()};
};

TEST_F(SaidBefore, WhatNobodyTookInPartInAnotherPartAndAllThatComesUntilItsSocketIsSettled) {
  taken_.holds = true;
  put(packet_);
  put(Octets{packet_}.first(5));
  hand_over();
  clients_.all_stopped();
  EXPECT_FALSE(clients_.is_settled(client_));
  put(Octets{packet_}.subspan(5));
  put(packet_);
  put(Octets{packet_}.first(1));
  clients_.settled(client_);
  EXPECT_TRUE(clients_.is_settled(client_));
  put(Octets{packet_}.subspan(1));
  put(packet_);
  taken_.holds = false;
  hand_over();
  EXPECT_THAT(taken_.said, ElementsAre(PerhapsBefore, PerhapsBefore, PerhapsBefore, PerhapsBefore, Since));
}

TEST_F(SaidBefore, AnotherStopHasThatOfBeforeToo) {
  clients_.all_stopped();
  clients_.settled(client_);
  put(packet_);
  hand_over();
  clients_.all_stopped();
  put(packet_);
  hand_over();
  clients_.settled(client_);
  put(packet_);
  hand_over();
  EXPECT_THAT(taken_.said, ElementsAre(Since, PerhapsBefore, Since));
}

struct SaidBeforeToServer : TcpServerTest {
  /// Steps of a millisecond.
  void pass(Duration span) {
    for (const TimePoint end = now_ + span; now_ < end; now_ += 1ms) next_ = server_->step(now_);
  }
  void say(Client& client, std::uint16_t count) {
    const std::uint64_t before = echo_.packets;
    ASSERT_EQ(client.send(telecommand(count)), 13U);
    until([&] { return echo_.packets > before; });
  }
};

TEST_F(SaidBeforeToServer, WhatComesInTheMomentsAfterAStopAndNothingLater) {
  Client client{port()};
  until_connected(1);
  ASSERT_EQ(client.send(telecommand(1)), 13U);
  server_->all_stopped();
  until([&] { return echo_.packets == 1; });
  pass(40ms);
  say(client, 2);
  pass(20ms);
  say(client, 3);
  EXPECT_THAT(echo_.said, ElementsAre(PerhapsBefore, PerhapsBefore, Since));
}

TEST_F(SaidBeforeToServer, WhatStandsAtTheClientsEndHoweverLateItComes) {
  Client client{port(GroundPort::TelecommandsOnly)};
  until_connected(1);
  echo_.room = 0;
  const auto packet = telecommand(1, 1000);
  std::size_t sent = 0;
  // Until both ends are full, with a part of a packet at last.
  for (int idle = 0; idle < 100; ++idle) {
    const std::size_t at = sent % packet.size();
    const std::size_t octets = client.send(Octets{packet}.subspan(at));
    sent += octets;
    if (octets != 0) idle = 0;
    next_ = server_->step(now_);
  }
  server_->all_stopped();
  pass(1s);
  echo_.room = 1'000'000;
  const std::size_t whole = sent / packet.size();
  until([&] {
    now_ += 1ms;
    return echo_.packets == whole;
  });
  EXPECT_GT(whole, 200U);
  EXPECT_EQ(std::ranges::count(echo_.said, Since), 0) << "of " << whole;
  for (std::size_t at = sent % packet.size(); at != 0 && at < packet.size();)
    at += client.send(Octets{packet}.subspan(at));
  pass(100ms);
  say(client, 2);
  EXPECT_EQ(echo_.said.back(), Since);
}

TEST_F(SaidBeforeToServer, OfWhoStoodAtTheDoorAndOfNobodyWhoComesLater) {
  Client early{port()};
  until([&] { return early.connected(); });
  ASSERT_EQ(early.send(telecommand(1)), 13U);
  server_->all_stopped();
  until([&] { return echo_.packets == 1; });
  pass(60ms);
  say(early, 2);
  Client late{port(GroundPort::TelecommandsOnly)};
  until([&] { return late.connected(); });
  ASSERT_EQ(late.send(telecommand(3)), 13U);
  until([&] { return echo_.packets == 3; });
  EXPECT_THAT(echo_.said, ElementsAre(PerhapsBefore, Since, Since));
}

}  // namespace
}  // namespace hirosco::communication
