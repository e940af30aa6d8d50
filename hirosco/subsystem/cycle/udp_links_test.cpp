// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "hirosco/subsystem/testing/inside.hpp"

/// A joint's angle by a link of UDP, from the handshake of ST[128] to the author's port. The test is the supervisor between the two.
namespace hirosco::angle_by_udp {
namespace {

namespace st128 = pus::st128;
using st128::Role;
using testing::Rig;

constexpr auto joint_descriptor = R"(<Subsystem name="JOINT" id="20">
  <Parameters><ParamRef name="ANGLE" id="1" type="DOUBLE"/></Parameters>
  <Configuration name="C" id="1" sampling_us="1000"><RealTimeLinkService>
    <Provides name="JOINT_STATE" methods="udp shared_memory"><ParamRef name="ANGLE"/></Provides>
  </RealTimeLinkService></Configuration></Subsystem>)";

constexpr auto observer_descriptor = R"(<Subsystem name="WATCHER" id="21">
  <Configuration name="C" id="1" sampling_us="1000"><RealTimeLinkService>
    <Requires name="JOINT_STATE" age="5" methods="shared_memory udp"><Field name="ANGLE" type="DOUBLE"/></Requires>
  </RealTimeLinkService></Configuration></Subsystem>)";

struct Joint final : Subsystem {
  Parameter<double> angle;

 protected:
  Result<Step> software_init() override {
    publish("ANGLE", angle);
    return done;
  }
};

struct Angle {
  double angle;
};

struct Observer final : Subsystem {
  LinkInput<Angle> joint;

 protected:
  Result<Step> software_init() override {
    require_link("JOINT_STATE", joint);
    return done;
  }
};

struct UdpLinks : ::testing::Test {
  Joint joint;
  std::optional<Rig> joint_rig{std::in_place, joint, joint_descriptor};
  Observer observer;
  Rig observer_rig{observer, observer_descriptor};
  std::array<std::byte, max_packet_octets> buffer{};
  st128::Agreement agreement;
  st128::Attached producer, consumer;

  void SetUp() override {
    joint_rig->bring_to(State::PreOperational);
    observer_rig.bring_to(State::PreOperational);
  }
  Octets first(const Result<std::size_t>& written) { return Octets{buffer}.first(written.value()); }
  static Octets said(const Rig& rig, std::uint8_t subtype) {
    Octets last;
    for (const auto& report : rig.telemetry)
      if (report.service == st128::service_type && report.subtype == subtype) last = report.data;
    return last;
  }
  std::string ask(Rig& rig, std::uint8_t subtype, const Result<std::size_t>& written) {
    const auto sent = rig.send(128, subtype, first(written));
    rig.service();
    rig.cycle();
    rig.service();
    return rig.outcome(sent);
  }
  void agree() {
    observer_rig.send(128, st128::request_offer, first(st128::write_offer_request(buffer, {1, "JOINT_STATE"})));
    observer_rig.settle();
    const auto offer = st128::read_offer(said(observer_rig, st128::offer)).value();
    joint_rig->send(128, st128::negotiate_terms,
                    first(st128::write_terms_request(buffer, {1, "JOINT_STATE", offer.offer})));
    joint_rig->settle();
    agreement = st128::read_agreement(said(*joint_rig, st128::agreement)).value().agreement;
  }
  std::string attach_producer(std::string at = "127.0.0.1") {
    return ask(*joint_rig, st128::attach,
               st128::write_attach_request(
                   buffer, {1,
                            Role::Producer,
                            7,
                            "JOINT_STATE",
                            agreement,
                            {.link = 1, .producer = std::move(at), .consumer = "127.0.0.1", .key = 0}}));
  }
  void couple() {
    agree();
    ASSERT_EQ(agreement.method, LinkMethod::Udp);
    ASSERT_EQ(attach_producer(), "1 3 7");
    producer = st128::read_attached(said(*joint_rig, st128::attached)).value();
    LinkRoute route = producer.route;
    route.consumer = "127.0.0.1";
    ASSERT_EQ(ask(observer_rig, st128::attach,
                  st128::write_attach_request(buffer, {1, Role::Consumer, 7, "JOINT_STATE", agreement, route})),
              "1 3 7");
    consumer = st128::read_attached(said(observer_rig, st128::attached)).value();
  }
  std::string reach(std::uint32_t epoch = 7) {
    return ask(*joint_rig, st128::reach, st128::write_reach_request(buffer, {1, epoch, consumer.route.consumer}));
  }
};

TEST_F(UdpLinks, BringWhatTheProducerMadeOnceItHasBeenToldOfItsConsumer) {
  couple();
  EXPECT_NE(producer.route.key, 0u);
  joint.angle.store(0.25);
  joint_rig->cycle(3);
  observer_rig.cycle();
  EXPECT_FALSE(observer.joint.valid()) << "nobody was reached yet";
  EXPECT_EQ(observer_rig.vital.judged[0].load(), link_not_judged);
  ASSERT_EQ(reach(), "1 3 7");
  for (const double angle : {0.5, -1.0, 3.25}) {
    joint.angle.store(angle);
    joint_rig->cycle();
    observer_rig.cycle();
    EXPECT_TRUE(observer.joint.valid());
    EXPECT_EQ(observer_rig.vital.judged[0].load(), link_valid) << "which nobody else can see";
    EXPECT_EQ(observer.joint.value().angle, angle);
  }
  EXPECT_EQ(observer.joint.lost(), 0u);
}

TEST_F(UdpLinks, AreReachedInTheirOwnHandshakeOnly) {
  couple();
  EXPECT_EQ(reach(6), "1 4:010700") << "an earlier epoch";
  EXPECT_EQ(ask(observer_rig, st128::reach, st128::write_reach_request(buffer, {1, 7, "127.0.0.1:4000"})), "1 4:010700")
      << "a consumer's end";
  EXPECT_EQ(ask(*joint_rig, st128::reach, st128::write_reach_request(buffer, {2, 7, "127.0.0.1:4000"})), "1 4:010700");
  EXPECT_EQ(ask(*joint_rig, st128::reach, st128::write_reach_request(buffer, {1, 7, "not an address"})), "1 4:010700");
  EXPECT_EQ(reach(), "1 3 7");
}

TEST_F(UdpLinks, CannotStandAtAnotherComputersAddress) {
  agree();
  EXPECT_EQ(attach_producer("192.0.2.1"), "1 4:010700");
  EXPECT_EQ(attach_producer(""), "1 4:010700") << "no address, no memory";
  EXPECT_EQ(attach_producer(), "1 3 7");
}

TEST_F(UdpLinks, OfAProducerThatDiesGetOldAndInhibit) {
  couple();
  ASSERT_EQ(reach(), "1 3 7");
  joint_rig->cycle();
  observer_rig.cycle();
  for (const State state : {State::SafeOperational, State::Operational}) {
    const auto sent = observer_rig.set_state(state);
    for (int i = 0; i < 12; ++i) {  // on the way up a sample in each cycle
      joint_rig->cycle();
      observer_rig.service();
      observer_rig.cycle();
    }
    ASSERT_EQ(observer_rig.outcome(sent), "1 3 7");
  }
  ASSERT_EQ(observer_rig.inhibited(), 0u);
  // Who is killed says nothing any more, and nobody says it for him.
  observer_rig.cycle(5);
  EXPECT_EQ(observer_rig.inhibited(), 0u) << "within its age";
  observer_rig.cycle();
  EXPECT_NE(observer_rig.inhibited(), 0u);
}

TEST_F(UdpLinks, OfAProducerThatEndsInOrderAreEndedAndNotStale) {
  couple();
  ASSERT_EQ(reach(), "1 3 7");
  joint_rig->cycle();
  observer_rig.cycle();
  ASSERT_EQ(joint_rig->set_state_now(State::PostOperational), "1 3 7");
  observer_rig.cycle();
  EXPECT_EQ(observer.joint.status(), LinkStatus::Stopping);
  EXPECT_FALSE(observer.joint.valid());
}

}  // namespace
}  // namespace hirosco::angle_by_udp
