// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"

/// What adr 0094 added to the handshake: a consumer whose cycle a sample starts, and memory that an earlier link of a lent set has.
namespace hirosco::pus::st128 {
namespace {

constexpr auto memory = LinkMethod::SharedMemory;

TEST(LinkWaking, TakesAWayThatWakesForAConsumerThatWaitsForSamples) {
  const auto offer = [](std::vector<LinkMethod> methods, bool wakes) {
    return Offer{.set = "SET",
                 .period = wakes ? 3ms : 2ms,
                 .terms = {.methods = std::move(methods)},
                 .fields = {{"A", Type::Double, 1}},
                 .wakes = wakes};
  };
  const auto way = [&](const Offer& consumer, const Carried& carried) {
    const auto result = negotiate(offer({LinkMethod::Udp, memory}, false), consumer, carried);
    return result ? std::string{to_text(result->method)} + (result->wakes ? " wakes" : "")
                  : std::to_string(result.error().item) + ": " + result.error().text;
  };
  const Carried memory_wakes = [](LinkMethod method, LinkKind, bool wakes) { return !wakes || method == memory; };
  EXPECT_EQ(way(offer({LinkMethod::Udp, memory}, false), memory_wakes), "udp");
  EXPECT_EQ(way(offer({LinkMethod::Udp, memory}, true), memory_wakes), "shared_memory wakes") << "of whatever rate";
  EXPECT_EQ(way(offer({LinkMethod::Udp}, true), memory_wakes), "6: wake: nothing here wakes a consumer by udp");
  EXPECT_EQ(way(offer({LinkMethod::Udp}, true), [](LinkMethod, LinkKind, bool) { return false; }),
            "0: method and kind: nothing here carries what both sides know, as udp with latest");
}

TEST(LinkWaking, OnlyALentSetHasTheMemoryOfAnEarlierLink) {
  const auto read = [](LinkKind kind, std::uint32_t epoch, std::uint32_t made) {
    const Agreement of{.method = memory,
                       .byte_order = descriptor::ByteOrder::Little,
                       .kind = kind,
                       .producer_period = 1ms,
                       .consumer_period = 1ms,
                       .fields = {{"A", Type::Double, 1}}};
    const AttachRequest request{
        .link = 1, .role = Role::Producer, .epoch = epoch, .set = "S", .agreement = of, .made = made};
    std::array<std::byte, 256> buffer{};
    return read_attach_request(Octets{buffer}.first(write_attach_request(buffer, request).value()));
  };
  EXPECT_EQ(read(LinkKind::Loaned, 9, 0)->header_epoch(), 9U);
  EXPECT_EQ(read(LinkKind::Loaned, 9, 4)->header_epoch(), 4U);
  EXPECT_EQ(read(LinkKind::Loaned, 9, 4)->epoch, 9U);
  EXPECT_FALSE(read(LinkKind::Loaned, 9, 9)) << "earlier";
  EXPECT_FALSE(read(LinkKind::Loaned, 9, 10));
  EXPECT_FALSE(read(LinkKind::Latest, 9, 4)) << "a consumer of what is copied has memory of its own";
}

}  // namespace
}  // namespace hirosco::pus::st128
