// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/handshake_under_way.hpp"

#include <gtest/gtest.h>

#include <array>
#include <tuple>

#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

namespace st128 = pus::st128;
using testing::arm;
using testing::camera;
using testing::hand;
using enum HandshakeUnderWay::Stage;

/// Of link 2, from HAND to ARM.
struct HandshakeUnderWayTest : ::testing::Test {
  descriptor::Mission mission = testing::small_mission();
  HandshakeUnderWay handshake;

  void SetUp() override {
    handshake.link = mission.find_link(2);
    handshake.producer = hand;
    handshake.consumer = arm;
    handshake.epoch = handshake.made = 5;
    handshake.agreement = {LinkMethod::SharedMemory,    descriptor::ByteOrder::Little, LinkKind::Latest, 0, 500us, 1ms,
                           {{"ANGLE", Type::Double, 2}}};
  }
  [[nodiscard]] st128::AttachRequest attach(st128::Role role) const {
    std::array<std::byte, 4096> buffer{};
    const auto octets = handshake.write_attach(buffer, role);
    return st128::read_attach_request(Octets{buffer}.first(octets.value())).value();
  }
};

TEST_F(HandshakeUnderWayTest, EachStageAwaitsAnAnswerOfOneEndToOneTelecommand) {
  const std::array awaited{std::tuple{AwaitOffer, arm, st128::request_offer},
                           std::tuple{AwaitAgreement, hand, st128::negotiate_terms},
                           std::tuple{AwaitProducer, hand, st128::attach},
                           std::tuple{AwaitConsumer, arm, st128::attach}, std::tuple{AwaitReached, hand, st128::reach}};
  for (const auto& [stage, end, subtype] : awaited) {
    handshake.stage = stage;
    for (const std::uint16_t apid : {arm, hand, camera})
      for (const std::uint8_t sent :
           {st128::request_offer, st128::negotiate_terms, st128::attach, st128::reach, st128::detach})
        EXPECT_EQ(handshake.awaits(apid, sent), apid == end && sent == subtype)
            << static_cast<int>(stage) << ' ' << apid << ' ' << static_cast<int>(sent);
  }
}

TEST_F(HandshakeUnderWayTest, EachEndIsToAttachToItsOwnSetUnderTheSameTerms) {
  EXPECT_EQ(attach(st128::Role::Producer).set, handshake.link->provides);
  EXPECT_EQ(attach(st128::Role::Consumer).set, handshake.link->requires_);
  for (const auto role : {st128::Role::Producer, st128::Role::Consumer}) {
    EXPECT_EQ(attach(role).role, role);
    EXPECT_EQ(attach(role).epoch, 5U);
    EXPECT_EQ(attach(role).agreement.layout_hash(), handshake.agreement.layout_hash());
  }
}

TEST_F(HandshakeUnderWayTest, AnEndIsToldForWhichEpochMemoryWasMadeThatIsNotOfThisOne) {
  EXPECT_EQ(attach(st128::Role::Producer).made, 0U);
  handshake.agreement.kind = LinkKind::Loaned;  // no other memory outlives its epoch
  handshake.made = 3;
  EXPECT_EQ(attach(st128::Role::Producer).made, 3U);
}

TEST_F(HandshakeUnderWayTest, WhatWasAgreedIsToldInWords) {
  EXPECT_EQ(handshake.terms(), "shared_memory, little endian, latest, 2000 Hz to 1000 Hz, 16 octets");
  handshake.route = {.link = 2, .producer = "127.0.0.1:5000", .consumer = "127.0.0.1:5001", .key = 0};
  EXPECT_TRUE(handshake.terms().ends_with(", 127.0.0.1:5000 to 127.0.0.1:5001")) << handshake.terms();
}

}  // namespace
}  // namespace hirosco::supervisor
