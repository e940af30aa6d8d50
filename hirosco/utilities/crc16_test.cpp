// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/crc16.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <random>
#include <vector>

namespace hirosco {
namespace {

using Bytes = std::vector<std::byte>;

/// The definition, bit by bit.
std::uint16_t crc16_bitwise(Octets octets) {
  unsigned crc = 0xFFFF;
  for (const std::byte octet : octets) {
    crc ^= std::to_integer<unsigned>(octet) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000) != 0 ? (crc << 1 ^ 0x1021) & 0xFFFF : crc << 1;
  }
  return static_cast<std::uint16_t>(crc);
}

std::uint16_t crc16_of(std::initializer_list<int> values) {
  Bytes octets;
  for (const int value : values) octets.push_back(static_cast<std::byte>(value));
  return crc16(octets);
}

/// ECSS-E-ST-70-41C B.1.5: what a conforming encoder makes of four strings.
TEST(Crc16, AgreesWithTheExamplesOfTheStandard) {
  EXPECT_EQ(crc16_of({0x00, 0x00}), 0x1D0F);
  EXPECT_EQ(crc16_of({0x00, 0x00, 0x00}), 0xCC9C);
  EXPECT_EQ(crc16_of({0xAB, 0xCD, 0xEF, 0x01}), 0x04A2);
  EXPECT_EQ(crc16_of({0x14, 0x56, 0xF8, 0x9A, 0x00, 0x01}), 0x7FD5);
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
  std::mt19937 random{2};
  Bytes octets(21);
  for (std::byte& octet : octets) octet = static_cast<std::byte>(random());
  for (std::size_t cut = 0; cut <= octets.size(); ++cut)
    EXPECT_EQ(crc16(Octets{octets}.subspan(cut), crc16(Octets{octets}.first(cut))), crc16(octets)) << cut;
}

}  // namespace
}  // namespace hirosco
