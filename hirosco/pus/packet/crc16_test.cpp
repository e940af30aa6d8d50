// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/crc16.hpp"

#include <gtest/gtest.h>

#include <random>

#include "hirosco/pus/packet/iso_checksum.hpp"
#include "hirosco/pus/testing/vectors.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;

/// The definition, bit by bit.
std::uint16_t crc16_bitwise(Octets octets) {
  unsigned crc = 0xFFFF;
  for (const std::byte octet : octets) {
    crc ^= std::to_integer<unsigned>(octet) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000) != 0 ? (crc << 1 ^ 0x1021) & 0xFFFF : crc << 1;
  }
  return static_cast<std::uint16_t>(crc);
}

std::uint16_t expected(const Vector& vector) { return OctetReader{vector.octets}.get<std::uint16_t>(); }

TEST(Crc16, AgreesWithSixOtherImplementations) {
  for (const auto& vector : vectors("crc16"))
    EXPECT_EQ(crc16(from_hex(vector.fields.at("input").get<std::string>())), expected(vector)) << vector.id;
}

TEST(Crc16, AgreesWithItsDefinitionAtEveryLength) {
  std::mt19937 random{1};
  Bytes octets;
  for (int length = 0; length < 100; ++length) {
    EXPECT_EQ(crc16(octets), crc16_bitwise(octets)) << length;
    octets.push_back(static_cast<std::byte>(random()));
  }
}

TEST(Crc16, CanBeContinuedAnywhere) {
  const Bytes octets = from_hex("00112233445566778899aabbccddeeff0123456789");
  for (std::size_t cut = 0; cut <= octets.size(); ++cut)
    EXPECT_EQ(crc16(Octets{octets}.subspan(cut), crc16(Octets{octets}.first(cut))), crc16(octets)) << cut;
}

TEST(IsoChecksum, AgreesWithTwoOtherImplementations) {
  for (const auto& vector : vectors("iso16"))
    EXPECT_EQ(iso_checksum(from_hex(vector.fields.at("input").get<std::string>())), expected(vector)) << vector.id;
}

}  // namespace
}  // namespace hirosco::pus
