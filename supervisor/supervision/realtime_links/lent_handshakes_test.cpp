// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "supervisor/supervision/testing/handshakes_rig.hpp"

/// A set that is lent has one memory for all its consumers (docs/adr/0094). Links 2 and 9 go from the same set of HAND to ARM and CAMERA.
namespace hirosco::supervisor {
namespace {

namespace st128 = pus::st128;
using st128::Role;
using testing::arm;
using testing::camera;
using testing::hand;

struct LentHandshakes : ::testing::Test {
  descriptor::Mission mission = [] {
    descriptor::Mission made = testing::small_mission();
    descriptor::MissionLink second = *made.find_link(2);
    second.id = 9;
    second.to = "CAMERA";
    second.requires_ = "VIEW";
    made.links.push_back(second);
    return made;
  }();
  HeapMemory memory;
  testing::LinkWitness supervisor;
  LinkGraph graph{mission};
  LinkHandshakes links{mission, graph, memory, standard_link_mechanisms(), supervisor};
  TimePoint now{};
  st128::Agreement agreement{.method = LinkMethod::SharedMemory,
                             .byte_order = descriptor::ByteOrder::Little,
                             .kind = LinkKind::Loaned,
                             .producer_period = 1ms,
                             .consumer_period = 1ms,
                             .fields = {{"PIXEL", Type::Uint8, 1000}}};

  void report(std::uint16_t from, std::uint8_t subtype, Octets data) {
    std::array<std::byte, 4096> buffer{};
    const auto packet = pus::write_telemetry(buffer, {.apid = from, .service = 128, .subtype = subtype}, data);
    links.handle(from, pus::TelemetryView::parse(packet.value()).value());
  }
  void attached(std::uint8_t link, std::uint16_t from, Role role) {
    std::array<std::byte, 64> buffer{};
    const auto octets = st128::write_attached(buffer, {.role = role, .route = {.link = link}});
    report(from, st128::attached, Octets{buffer}.first(octets.value()));
  }
  void detached(std::uint8_t link, std::uint16_t from, Role role) {
    report(from, st128::detached, std::array{std::byte{link}, static_cast<std::byte>(role)});
  }
  static std::uint16_t consumer_of(std::uint8_t link) { return link == 2 ? arm : camera; }
  /// Up to the request that the producer attaches.
  st128::AttachRequest agree(std::uint8_t link) {
    EXPECT_TRUE(links.establish(link, now, {}));
    std::array<std::byte, 4096> buffer{};
    const st128::Offer offer{
        .set = "VIEW", .period = 1ms, .terms = {.kinds = {LinkKind::Loaned}}, .fields = agreement.fields};
    report(consumer_of(link), st128::offer, Octets{buffer}.first(st128::write_offer(buffer, link, offer).value()));
    report(hand, st128::agreement, Octets{buffer}.first(st128::write_agreement(buffer, link, agreement).value()));
    return st128::read_attach_request(supervisor.last).value();
  }
  st128::AttachRequest bring_up(std::uint8_t link) {
    agree(link);
    attached(link, hand, Role::Producer);
    const auto request = st128::read_attach_request(supervisor.last).value();
    attached(link, consumer_of(link), Role::Consumer);
    EXPECT_TRUE(graph.is_up(link));
    return request;
  }
};

TEST_F(LentHandshakes, HandTheMemoryOfTheFirstLinkToTheNext) {
  const auto first = bring_up(2);
  const auto block = supervisor.last_memory.block();
  EXPECT_EQ(first.made, 0U);
  const auto next = bring_up(9);
  EXPECT_EQ(supervisor.last_memory.block(), block) << "one memory";
  EXPECT_EQ(next.made, first.epoch);
  EXPECT_GT(next.epoch, first.epoch) << "and each its own epoch";
}

TEST_F(LentHandshakes, ThatRunSideBySideShareToo) {
  const auto first = agree(2);
  const auto block = supervisor.last_memory.block();
  const auto next = agree(9);
  EXPECT_EQ(supervisor.last_memory.block(), block);
  EXPECT_EQ(next.made, first.epoch);
}

TEST_F(LentHandshakes, MakeNewMemoryWhenTheProducerHasLetGoOfTheOld) {
  bring_up(2);
  const auto block = supervisor.last_memory.block();
  detached(2, hand, Role::Producer);
  EXPECT_EQ(bring_up(9).made, 0U);
  EXPECT_NE(supervisor.last_memory.block(), block);
}

TEST_F(LentHandshakes, MakeNewMemoryForAnotherLayout) {
  bring_up(2);
  agreement.fields[0].count = 2000;
  EXPECT_EQ(bring_up(9).made, 0U) << "its producer has another configuration by now";
}

TEST_F(LentHandshakes, MakeNewMemoryAfterTheProducerDied) {
  bring_up(2);
  links.forget(hand);
  EXPECT_EQ(bring_up(9).made, 0U);
}

TEST_F(LentHandshakes, ThatFailInSharedMemoryTryTheNextTimeInTheirOwn) {
  bring_up(2);
  EXPECT_NE(agree(9).made, 0U);
  std::array<std::byte, 256> buffer{};
  report(hand, st128::refusal, Octets{buffer}.first(st128::write_refusal(buffer, 9, {0, "sealed"}).value()));
  EXPECT_EQ(bring_up(9).made, 0U);
}

TEST_F(LentHandshakes, OfWhatIsCopiedHaveMemoryOfTheirOwn) {
  agreement.kind = LinkKind::Latest;
  bring_up(2);
  const auto block = supervisor.last_memory.block();
  EXPECT_EQ(bring_up(9).made, 0U);
  EXPECT_NE(supervisor.last_memory.block(), block);
}

}  // namespace
}  // namespace hirosco::supervisor
