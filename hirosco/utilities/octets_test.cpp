// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/octets.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

namespace hirosco {
namespace {

[[nodiscard]] std::vector<std::byte> octets(std::initializer_list<int> values) {
  std::vector<std::byte> made;
  for (const int value : values) made.push_back(static_cast<std::byte>(value));
  return made;
}
[[nodiscard]] std::vector<std::byte> copy_of(Octets from) { return {from.begin(), from.end()}; }

TEST(OctetWriter, WritesMostSignificantOctetFirst) {
  std::array<std::byte, 15> buffer{};
  OctetWriter writer{buffer};
  writer.put(std::uint8_t{0x01}).put(std::uint16_t{0x0203}).put(std::uint32_t{0x0405'0607}).put(std::int64_t{-2});
  EXPECT_TRUE(writer.good());
  EXPECT_EQ(copy_of(writer.written()), octets({1, 2, 3, 4, 5, 6, 7, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE}));
}

TEST(OctetWriter, WritesNumbersOfIeee754) {
  // 1.0 and -2.5 as in the tables of the standard's formats.
  std::array<std::byte, 12> buffer{};
  OctetWriter writer{buffer};
  writer.put(1.0F).put(-2.5);
  EXPECT_EQ(copy_of(writer.written()), octets({0x3F, 0x80, 0, 0, 0xC0, 0x04, 0, 0, 0, 0, 0, 0}));
}

TEST(OctetWriter, WritesLittleEndianWhenAsked) {
  std::array<std::byte, 6> buffer{};
  OctetWriter writer{buffer, std::endian::little};
  writer.put(std::uint32_t{0x0102'0304}).put(std::uint16_t{0x0506});
  EXPECT_EQ(copy_of(writer.written()), octets({4, 3, 2, 1, 6, 5}));
}

TEST(OctetWriter, OverrunIsStickyAndWritesNothingBeyond) {
  std::array<std::byte, 4> buffer{};
  buffer[3] = std::byte{0xEE};
  OctetWriter writer{MutableOctets{buffer}.first(3)};
  writer.put(std::uint16_t{1}).put(std::uint16_t{2}).put(std::uint8_t{3});
  EXPECT_FALSE(writer.good());
  EXPECT_EQ(writer.size(), 2U) << "what would fit after an overrun is not written either";
  EXPECT_EQ(buffer[2], std::byte{0});
  EXPECT_EQ(buffer[3], std::byte{0xEE});
  OctetWriter filler{MutableOctets{buffer}.first(3)};
  EXPECT_FALSE(filler.fill(std::numeric_limits<std::size_t>::max(), std::byte{1}).good());
}

TEST(OctetWriter, WritesRunsAndFillings) {
  std::array<std::byte, 5> buffer{};
  OctetWriter writer{buffer};
  writer.put(Octets{}).put(Octets{octets({9, 8})}).fill(0, std::byte{1}).fill(3, std::byte{7});
  EXPECT_TRUE(writer.good());
  EXPECT_EQ(copy_of(writer.written()), octets({9, 8, 7, 7, 7}));
}

TEST(OctetReader, ReadsBackWhatTheWriterWroteInBothOrders) {
  for (const std::endian order : {std::endian::big, std::endian::little}) {
    std::array<std::byte, 64> buffer{};
    OctetWriter writer{buffer, order};
    writer.put(std::int8_t{-5})
        .put(std::uint16_t{65535})
        .put(std::int32_t{-70000})
        .put(~std::uint64_t{0})
        .put(0.1F)
        .put(-0.0);
    OctetReader reader{writer.written(), order};
    EXPECT_EQ(reader.get<std::int8_t>(), -5);
    EXPECT_EQ(reader.get<std::uint16_t>(), 65535);
    EXPECT_EQ(reader.get<std::int32_t>(), -70000);
    EXPECT_EQ(reader.get<std::uint64_t>(), ~std::uint64_t{0});
    EXPECT_EQ(reader.get<float>(), 0.1F);
    EXPECT_TRUE(std::signbit(reader.get<double>()));
    EXPECT_TRUE(reader.exhausted());
  }
}

TEST(OctetReader, UnderrunIsStickyAndReadsAsZero) {
  const auto given = octets({1, 2, 3});
  OctetReader reader{given};
  EXPECT_EQ(reader.get<std::uint16_t>(), 0x0102);
  EXPECT_EQ(reader.get<std::uint16_t>(), 0);
  EXPECT_FALSE(reader.good());
  EXPECT_EQ(reader.get<std::uint8_t>(), 0) << "what is there after an underrun is not read either";
  EXPECT_TRUE(reader.get(std::numeric_limits<std::size_t>::max()).empty());
  EXPECT_FALSE(reader.exhausted());
  EXPECT_EQ(reader.position(), 2U);
}

TEST(OctetReader, GivesRunsAndTheRest) {
  const auto given = octets({1, 2, 3, 4});
  OctetReader reader{given};
  EXPECT_EQ(copy_of(reader.get(2)), octets({1, 2}));
  EXPECT_EQ(copy_of(reader.rest()), octets({3, 4}));
  EXPECT_EQ(reader.remaining(), 2U);
  EXPECT_TRUE(reader.get(0).empty());
  EXPECT_TRUE(reader.good());
}

TEST(ByteSwapped, ReversesTheOctets) {
  static_assert(byte_swapped(std::uint8_t{0x12}) == 0x12);
  static_assert(byte_swapped(std::uint16_t{0x1234}) == 0x3412);
  static_assert(byte_swapped(std::uint32_t{0x1234'5678}) == 0x7856'3412);
  static_assert(byte_swapped(std::uint64_t{0x0102'0304'0506'0708}) == 0x0807'0605'0403'0201);
}

}  // namespace
}  // namespace hirosco
