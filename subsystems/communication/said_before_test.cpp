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

TEST_F(SaidBefore, WhatNobodyTookInPartInAnotherPartOrInItsSocket) {
  taken_.holds = true;
  put(packet_);
  put(Octets{packet_}.first(5));
  hand_over();
  clients_.all_stopped(client_, packet_.size() - 5 + packet_.size());
  put(Octets{packet_}.subspan(5));
  put(packet_);
  put(packet_);
  taken_.holds = false;
  hand_over();
  EXPECT_THAT(taken_.said, ElementsAre(PerhapsBefore, PerhapsBefore, PerhapsBefore, Since));
}

TEST_F(SaidBefore, WhatHadBegunAndNothingBehindIt) {
  put(packet_);
  hand_over();
  put(Octets{packet_}.first(1));
  clients_.all_stopped(client_, 0);
  put(Octets{packet_}.subspan(1));
  put(packet_);
  hand_over();
  EXPECT_THAT(taken_.said, ElementsAre(Since, PerhapsBefore, Since));
}

TEST_F(TcpServerTest, WhatLiesInASocketWhenEverythingIsStoppedWasPerhapsSaidBefore) {
  Client client{port()};
  until_connected(1);
  ASSERT_EQ(client.send(telecommand(1)), 13U);
  ASSERT_EQ(client.send(telecommand(2)), 13U);
  server_->all_stopped();
  ASSERT_EQ(client.send(telecommand(3)), 13U);
  until([&] { return echo_.packets == 3; });
  EXPECT_THAT(echo_.said, ElementsAre(PerhapsBefore, PerhapsBefore, Since));
}

TEST_F(TcpServerTest, WhoStandsAtTheDoorWhenEverythingIsStoppedPerhapsSpokeBefore) {
  Client early{port()};
  until([&] { return early.connected(); });
  ASSERT_EQ(early.send(telecommand(1)), 13U);
  server_->all_stopped();
  until([&] { return echo_.packets == 1; });
  ASSERT_EQ(early.send(telecommand(2)), 13U);
  until([&] { return echo_.packets == 2; });
  Client late{port(GroundPort::TelecommandsOnly)};
  until([&] { return late.connected(); });
  ASSERT_EQ(late.send(telecommand(3)), 13U);
  until([&] { return echo_.packets == 3; });
  EXPECT_THAT(echo_.said, ElementsAre(PerhapsBefore, Since, Since));
}

}  // namespace
}  // namespace hirosco::communication
