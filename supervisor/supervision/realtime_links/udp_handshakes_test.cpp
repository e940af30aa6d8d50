// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "supervisor/supervision/testing/handshakes_rig.hpp"

namespace hirosco::supervisor {
namespace {

namespace st128 = pus::st128;
using st128::Role;
using testing::arm;
using ::testing::ElementsAre;
using testing::hand;

/// The same link by UDP: its ends are told where the other one stands.
struct UdpHandshakesTest : testing::LinkHandshakesTest {
  UdpHandshakesTest() {
    mission.links[1].method = LinkMethod::Udp;
    mission.links[1].from_address = "192.0.2.1";
    mission.links[1].to_address = "192.0.2.2:4000";
    offer.terms.methods = {LinkMethod::SharedMemory, LinkMethod::Udp};
    agreement.method = LinkMethod::Udp;
  }
  const LinkRoute produced{.link = 2, .producer = "192.0.2.1:5000", .consumer = {}, .key = 77};
  const LinkRoute consumed{.link = 2, .producer = {}, .consumer = "192.0.2.2:4000", .key = 0};
};

TEST_F(UdpHandshakesTest, TheConsumerLearnsWhereItsProducerStandsAndTheProducerIsToldOfItsConsumerLast) {
  advance(1);
  EXPECT_THAT(st128::read_terms_request(supervisor.last)->consumer.terms.methods, ElementsAre(LinkMethod::Udp))
      << "what the mission wants";
  agrees();
  const auto to_producer = *st128::read_attach_request(supervisor.last);
  EXPECT_EQ(to_producer.route, (LinkRoute{.link = 2, .producer = "192.0.2.1", .consumer = "192.0.2.2:4000", .key = 0}));
  attaches(hand, Role::Producer, produced);
  const auto to_consumer = *st128::read_attach_request(supervisor.last);
  EXPECT_EQ(to_consumer.route.producer, "192.0.2.1:5000");
  EXPECT_EQ(to_consumer.route.key, 77u);
  attaches(arm, Role::Consumer, consumed);
  EXPECT_FALSE(graph.is_up(2)) << "nothing flows yet";
  const auto reach = *st128::read_reach_request(supervisor.last);
  EXPECT_EQ(reach.consumer, "192.0.2.2:4000");
  EXPECT_EQ(reach.epoch, to_producer.epoch);
  attaches(hand, Role::Producer, produced);
  EXPECT_TRUE(graph.is_up(2));
  EXPECT_THAT(supervisor.take(), ElementsAre("10<-1", "11<-2", "11<-3", "10<-3", "11<-5")) << "no memory beside";
  EXPECT_THAT(supervisor.changes, ElementsAre("2 up: udp, little endian, latest, 2000 Hz to 1000 Hz, 16 octets, "
                                              "192.0.2.1:5000 to 192.0.2.2:4000"));
  EXPECT_FALSE(links.can_look(2)) << "samples do not pass here";
  EXPECT_FALSE(links.glance(2));
}

TEST_F(UdpHandshakesTest, WithoutAddressesBothEndsStandInThisComputer) {
  mission.links[1].from_address = mission.links[1].to_address = "";
  advance(2);
  const auto route = st128::read_attach_request(supervisor.last)->route;
  EXPECT_EQ(route.producer, "127.0.0.1");
  EXPECT_EQ(route.consumer, "127.0.0.1");
}

TEST_F(UdpHandshakesTest, AnEndThatStandsWhereTheMissionDoesNotPutItGetsNoLink) {
  for (const char* at : {"192.0.2.9:5000", "192.0.2.1", "", "somewhere"}) {
    advance(2);
    attaches(hand, Role::Producer, {.link = 2, .producer = at, .consumer = {}, .key = 1});
    EXPECT_FALSE(ends.back()) << at;
  }
  for (const char* at : {"192.0.2.2:4001", "192.0.2.3:4000", ""}) {
    advance(2);
    attaches(hand, Role::Producer, produced);
    supervisor.take();
    attaches(arm, Role::Consumer, {.link = 2, .producer = {}, .consumer = at, .key = 0});
    EXPECT_FALSE(ends.back()) << at;
    EXPECT_THAT(supervisor.take(), ElementsAre("10<-4", "11<-4")) << "both ends are taken back";
  }
}

TEST_F(UdpHandshakesTest, AProducerThatCannotReachItsConsumerEndsTheHandshakeAtBothEnds) {
  const auto reached = [&] {
    advance(2);
    attaches(hand, Role::Producer, produced);
    attaches(arm, Role::Consumer, consumed);
    supervisor.take();
  };
  reached();
  refuses(hand);
  EXPECT_THAT(supervisor.take(), ElementsAre("10<-4")) << "who refused needs no word";
  reached();
  links.failed(hand, st128::reach, 2, "HAND: it has gone");
  links.step(now);
  EXPECT_THAT(supervisor.take(), ElementsAre("10<-4", "11<-4"));
  reached();
  detaches(arm, Role::Consumer);
  EXPECT_THAT(supervisor.take(), ElementsAre("11<-4"));
  reached();
  links.step(now + 1h);
  EXPECT_THAT(supervisor.take(), ElementsAre("10<-4", "11<-4"));
  EXPECT_THAT(ends, ElementsAre(false, false, false, false));
}

TEST_F(UdpHandshakesTest, AConsumerThatLacksTheMethodOfTheMissionGetsNoLink) {
  offer.terms.methods = {LinkMethod::SharedMemory};
  advance(1);
  EXPECT_THAT(ends, ElementsAre(false));
  EXPECT_THAT(supervisor.changes, ElementsAre("2 down: the mission wants udp, the consumer has it not"));
}

}  // namespace
}  // namespace hirosco::supervisor
