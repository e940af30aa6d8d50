// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/link/link_datagram.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "hirosco/utilities/crc16.hpp"

namespace hirosco {
namespace {

using Datagram = std::vector<std::byte>;

const LinkLayout layout{.epoch = 0x01020304,
                        .payload_octets = 3,
                        .layout_hash = 0x1112'1314'1516'1718,
                        .period = 1ms,
                        .route = {.link = 7, .producer = {}, .consumer = {}, .key = 0x2122'2324'2526'2728}};
constexpr std::array payload{std::byte{0xA0}, std::byte{0xA1}, std::byte{0xA2}};

Datagram datagram(std::uint64_t sequence, std::uint64_t count, const LinkLayout& of = layout,
                  LinkStatus status = LinkStatus::Degraded) {
  Datagram octets(link_datagram_octets(of.payload_octets));
  write_link_datagram(octets, of, {status, sequence, count, TimePoint{Duration{0x3132}}}, payload);
  return octets;
}

void seal(Datagram& octets) {
  const std::uint16_t sum = crc16(Octets{octets}.first(octets.size() - 2));
  octets[octets.size() - 2] = static_cast<std::byte>(sum >> 8);
  octets[octets.size() - 1] = static_cast<std::byte>(sum & 0xFF);
}

// The check sum is that of Python's binascii.crc_hqx(octets, 0xFFFF).
TEST(LinkDatagram, IsAsTheDocumentHasItOctetByOctet) {
  const std::array<unsigned, 61> expected{0x48, 0x4C, 0x4E, 0x4B, 0x00, 0x01, 0x07, 0x02, 0x01, 0x02, 0x03, 0x04, 0x00,
                                          0x00, 0x00, 0x03, 0x11, 0x12, 0x13, 0x14, 0x15, 0x16, 0x17, 0x18, 0x21, 0x22,
                                          0x23, 0x24, 0x25, 0x26, 0x27, 0x28, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                                          0x09, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x05, 0x00, 0x00, 0x00, 0x00,
                                          0x00, 0x00, 0x31, 0x32, 0xA0, 0xA1, 0xA2, 0x9B, 0xF6};
  const Datagram made = datagram(9, 5);
  ASSERT_EQ(made.size(), expected.size());
  for (std::size_t i = 0; i < made.size(); ++i) EXPECT_EQ(std::to_integer<unsigned>(made[i]), expected[i]) << i;
}

TEST(LinkDatagram, IsTakenOnceAndNeverAfterALaterOne) {
  LinkDatagramGate gate{layout};
  const auto first = gate.take(datagram(1, 1));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->head.status, LinkStatus::Degraded);
  EXPECT_EQ(first->head.sampled_at, TimePoint{Duration{0x3132}});
  EXPECT_FALSE(gate.take(datagram(1, 1))) << "doubled";
  EXPECT_TRUE(gate.take(datagram(4, 3)));
  EXPECT_FALSE(gate.take(datagram(2, 2))) << "overtaken";
  EXPECT_TRUE(gate.take(datagram(5, 3))) << "the same sample with another status";
  EXPECT_FALSE(gate.take(datagram(6, 2))) << "an older sample is newer than nothing";
  EXPECT_EQ(gate.refusals().late, 3u);
  EXPECT_EQ(gate.refusals().damaged + gate.refusals().foreign, 0u);
}

TEST(LinkDatagram, OfAnythingElseThatWasAgreedIsForeign) {
  LinkDatagramGate gate{layout};
  const auto other = [&](auto change) {
    LinkLayout of = layout;
    change(of);
    return gate.take(datagram(1, 1, of)).has_value();
  };
  EXPECT_FALSE(other([](LinkLayout& of) { --of.epoch; }));
  EXPECT_FALSE(other([](LinkLayout& of) { of.layout_hash ^= 1; }));
  EXPECT_FALSE(other([](LinkLayout& of) { of.route.key ^= 1ULL << 63; }));
  EXPECT_FALSE(other([](LinkLayout& of) { ++of.route.link; }));
  EXPECT_EQ(gate.refusals().foreign, 4u);
  EXPECT_TRUE(other([](LinkLayout&) {}));
}

TEST(LinkDatagram, WithOneWrongOctetIsNeverTaken) {
  for (std::size_t at = 0; at < datagram(1, 1).size(); ++at)
    for (const unsigned flip : {1U, 0x80U, 0xFFU}) {
      LinkDatagramGate gate{layout};
      Datagram octets = datagram(1, 1);
      octets[at] ^= static_cast<std::byte>(flip);
      EXPECT_FALSE(gate.take(octets)) << at;
      EXPECT_EQ(gate.refusals().damaged, 1u);
    }
}

TEST(LinkDatagram, OfAnotherFormIsNotTakenThoughItsSumIsRight) {
  const auto refused = [](auto change) {
    Datagram octets = datagram(5, 5);
    change(octets);
    seal(octets);
    LinkDatagramGate gate{layout};
    return !gate.take(octets) && gate.refusals().damaged == 1;
  };
  EXPECT_FALSE(refused([](Datagram&) {}));
  EXPECT_TRUE(refused([](Datagram& of) { of[0] = std::byte{0}; })) << "magic";
  EXPECT_TRUE(refused([](Datagram& of) { of[5] = std::byte{2}; })) << "version";
  EXPECT_TRUE(refused([](Datagram& of) { of[7] = std::byte{5}; })) << "status";
  EXPECT_TRUE(refused([](Datagram& of) { of[47] = std::byte{6}; })) << "more samples than datagrams";
  EXPECT_TRUE(refused([](Datagram& of) { of.push_back(std::byte{0}); })) << "longer than it says";
  EXPECT_TRUE(refused([](Datagram& of) { of.resize(60); })) << "shorter than it says";
}

TEST(LinkDatagram, OfNoLengthBreaksAnything) {
  LinkDatagramGate gate{layout};
  for (std::size_t octets = 0; octets < 80; ++octets) EXPECT_FALSE(gate.take(Datagram(octets)));
  EXPECT_EQ(gate.refusals().damaged, 80u);
}

TEST(LinkDatagram, WhateverANetworkDoesSamplesGoForwardOnly) {
  std::mt19937 draw{7};
  LinkDatagramGate gate{layout};
  std::vector<Datagram> under_way;
  std::uint64_t sequence = 0, last = 0, taken = 0;
  for (int round = 0; round < 20'000; ++round) {
    ++sequence;
    under_way.push_back(datagram(sequence, sequence));
    if (draw() % 4 == 0) under_way.push_back(under_way[draw() % under_way.size()]);
    while (under_way.size() > 8) {
      const std::size_t which = draw() % under_way.size();
      Datagram octets = under_way[which];
      under_way.erase(under_way.begin() + static_cast<std::ptrdiff_t>(which));
      const auto fate = draw() % 10;
      if (fate == 0) continue;
      if (fate == 1) octets[draw() % octets.size()] ^= static_cast<std::byte>(1 + draw() % 255);
      if (const auto found = gate.take(octets)) {
        ASSERT_GT(found->head.count, last);
        ASSERT_NE(fate, 1U);
        last = found->head.count;
        ++taken;
      }
    }
  }
  EXPECT_GT(taken, 2'000u);
  EXPECT_GT(gate.refusals().late, 2'000u);
  EXPECT_GT(gate.refusals().damaged, 1'000u);
}

}  // namespace
}  // namespace hirosco
