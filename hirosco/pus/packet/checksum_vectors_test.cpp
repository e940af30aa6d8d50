// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/pus/packet/iso_checksum.hpp"
#include "hirosco/pus/testing/vectors.hpp"
#include "hirosco/utilities/crc16.hpp"

/// Both checksums of packets by what independent implementations made of them; CRC-16 besides in utilities/crc16_test.cpp.

namespace hirosco::pus {
namespace {
using namespace testing;

std::uint16_t expected(const Vector& vector) { return OctetReader{vector.octets}.get<std::uint16_t>(); }

TEST(ChecksumVectors, Crc16AgreesWithSixOtherImplementations) {
  for (const auto& vector : vectors("crc16"))
    EXPECT_EQ(crc16(from_hex(vector.fields.at("input").get<std::string>())), expected(vector)) << vector.id;
}

TEST(ChecksumVectors, IsoChecksumAgreesWithTwoOtherImplementations) {
  for (const auto& vector : vectors("iso16"))
    EXPECT_EQ(iso_checksum(from_hex(vector.fields.at("input").get<std::string>())), expected(vector)) << vector.id;
}

}  // namespace
}  // namespace hirosco::pus
