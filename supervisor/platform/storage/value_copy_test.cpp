// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/value_copy.hpp"

#include <gtest/gtest.h>

namespace hirosco::supervisor {
namespace {

[[nodiscard]] std::vector<std::byte> some_octets(std::size_t count) {
  std::vector<std::byte> octets(count);
  for (std::size_t i = 0; i < count; ++i) octets[i] = static_cast<std::byte>(i * 37 + 1);
  return octets;
}

const ValueCopy some_copy{0x0123'4567'89AB'CDEF, 17, OnboardTime{std::chrono::seconds{2'145'916'837}}, some_octets(13)};

/// By the definition of IEEE 802.3, bit by bit over a polynomial division: not the code's way.
[[nodiscard]] std::uint32_t divided(Octets octets) {
  std::uint32_t remainder = 0xFFFF'FFFF;
  const auto shift_in = [&](bool bit) {
    const bool out = (remainder >> 31 & 1U) != (bit ? 1U : 0U);
    remainder = (remainder << 1) ^ (out ? 0x04C1'1DB7U : 0U);
  };
  for (const std::byte octet : octets)
    for (int bit = 0; bit < 8; ++bit) shift_in((std::to_integer<unsigned>(octet) >> bit & 1U) != 0);
  std::uint32_t reflected = 0;
  for (int bit = 0; bit < 32; ++bit) reflected |= (remainder >> bit & 1U) << (31 - bit);
  return ~reflected;
}

TEST(ValueCopy, IsReadAsItWasWritten) {
  EXPECT_EQ(read_copy(write_copy(some_copy)), some_copy);
  EXPECT_EQ(read_copy(write_copy({})), ValueCopy{});
}

TEST(ValueCopy, StandsOctetByOctetAsTheDocumentSays) {
  const auto octets = write_copy({0x0102'0304'0506'0708, 9, OnboardTime{Duration{10}}, some_octets(2)});
  OctetReader reader{octets};
  EXPECT_EQ(reader.get<std::uint32_t>(), 0x48565043U);
  EXPECT_EQ(reader.get<std::uint16_t>(), 1);
  EXPECT_EQ(reader.get<std::uint64_t>(), 0x0102'0304'0506'0708U);
  EXPECT_EQ(reader.get<std::uint64_t>(), 9U);
  EXPECT_EQ(reader.get<std::int64_t>(), 10);
  EXPECT_EQ(reader.get<std::uint32_t>(), 2U);
  static_cast<void>(reader.get(std::size_t{2}));
  EXPECT_EQ(reader.get<std::uint32_t>(), divided(Octets{octets}.first(octets.size() - 4)));
  EXPECT_TRUE(reader.exhausted());
}

TEST(ValueCopy, WithAnyOctetDamagedIsNone) {
  const auto whole = write_copy(some_copy);
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (unsigned change = 1; change < 256; ++change) {
      auto damaged = whole;
      damaged[at] ^= static_cast<std::byte>(change);
      ASSERT_EQ(read_copy(damaged), std::unexpected{CopyFault::Damaged}) << at << " " << change;
    }
}

TEST(ValueCopy, CutAtAnyLengthOrLengthenedIsNone) {
  auto octets = write_copy(some_copy);
  for (std::size_t length = 0; length < octets.size(); ++length)
    EXPECT_EQ(read_copy(Octets{octets}.first(length)), std::unexpected{CopyFault::Damaged}) << length;
  octets.push_back({});
  EXPECT_EQ(read_copy(octets), std::unexpected{CopyFault::Damaged});
  EXPECT_EQ(read_copy(std::vector<std::byte>(4096)), std::unexpected{CopyFault::Damaged});
}

/// Puts the right sum behind what was changed.
[[nodiscard]] std::vector<std::byte> with_sum(std::vector<std::byte> octets) {
  OctetWriter{MutableOctets{octets}.last(4)}.put(divided(Octets{octets}.first(octets.size() - 4)));
  return octets;
}

TEST(ValueCopy, OfAnotherVersionIsNamedAsSuch) {
  auto octets = write_copy(some_copy);
  octets[5] = std::byte{2};
  EXPECT_EQ(read_copy(with_sum(octets)), std::unexpected{CopyFault::Version});
}

TEST(ValueCopy, WhoseLengthIsNotItsOwnIsNoneThoughTheSumIsRight) {
  const std::size_t length_at = 4 + 2 + 8 + 8 + 8 + 3;
  for (const unsigned length : {0U, 12U, 14U, 255U}) {
    auto octets = write_copy(some_copy);
    octets[length_at] = static_cast<std::byte>(length);
    EXPECT_EQ(read_copy(with_sum(octets)), std::unexpected{CopyFault::Damaged}) << length;
  }
}

}  // namespace
}  // namespace hirosco::supervisor
