// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/wire_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace hirosco {
namespace {

struct Sample {
  std::uint8_t flags{0xA5};
  double position_rad{1.0};
  std::int16_t steps[3]{1, -2, 0x1234};
  float torque_n_m{-2.0F};
};

constexpr std::array<LayoutField, 4> fields{
    LayoutField{Type::Uint8, 1, offsetof(Sample, flags)}, LayoutField{Type::Double, 1, offsetof(Sample, position_rad)},
    LayoutField{Type::Int16, 3, offsetof(Sample, steps)}, LayoutField{Type::Float, 1, offsetof(Sample, torque_n_m)}};

Octets octets_of_object(const Sample& sample) { return std::as_bytes(std::span{&sample, 1}); }

std::vector<std::byte> wire(std::initializer_list<int> octets) {
  std::vector<std::byte> bytes;
  for (const int octet : octets) bytes.push_back(static_cast<std::byte>(octet));
  return bytes;
}

// Written by hand from IEEE 754: 1.0 is 3FF0 0000 0000 0000, -2.0f is C000 0000.
const std::vector<std::byte> big =
    wire({0xA5, 0x3F, 0xF0, 0, 0, 0, 0, 0, 0, 0x00, 0x01, 0xFF, 0xFE, 0x12, 0x34, 0xC0, 0x00, 0x00, 0x00});
const std::vector<std::byte> little =
    wire({0xA5, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F, 0x01, 0x00, 0xFE, 0xFF, 0x34, 0x12, 0x00, 0x00, 0x00, 0xC0});

TEST(Layout, HasNoGapsOnTheWire) {
  EXPECT_EQ(wire_octets(fields), 19u);
  EXPECT_EQ(native_octets(fields), offsetof(Sample, torque_n_m) + 4);
  EXPECT_EQ(wire_octets({}), 0u);
}

TEST(Layout, WritesTheByteOrderOfTheWire) {
  std::vector<std::byte> out(19);
  encode(fields, octets_of_object(Sample{}), out, std::endian::big);
  EXPECT_EQ(out, big);
  encode(fields, octets_of_object(Sample{}), out, std::endian::little);
  EXPECT_EQ(out, little);
}

TEST(Layout, ReadsTheByteOrderOfTheWire) {
  for (const auto& [octets, order] : {std::pair{big, std::endian::big}, std::pair{little, std::endian::little}}) {
    Sample sample{0, 0, {0, 0, 0}, 0};
    decode(fields, octets, std::as_writable_bytes(std::span{&sample, 1}), order);
    EXPECT_EQ(sample.flags, 0xA5);
    EXPECT_EQ(sample.position_rad, 1.0);
    EXPECT_EQ(sample.steps[1], -2);
    EXPECT_EQ(sample.steps[2], 0x1234);
    EXPECT_EQ(sample.torque_n_m, -2.0F);
  }
}

TEST(Layout, LeavesOctetsBetweenTheFieldsAlone) {
  std::array<std::byte, sizeof(Sample)> object;
  object.fill(std::byte{0x77});
  decode(fields, big, object, std::endian::big);
  EXPECT_EQ(object[1], std::byte{0x77}) << "padding after the first field";
}

TEST(Layout, PassesOverAStructureItself) {
  const std::array<LayoutField, 2> nested{LayoutField{Type::Struct, 1, 0}, LayoutField{Type::Uint8, 1, 0}};
  EXPECT_EQ(wire_octets(nested), 1u);
  std::array<std::byte, 1> out{};
  encode(nested, std::array{std::byte{9}}, out, std::endian::big);
  EXPECT_EQ(out[0], std::byte{9});
}

TEST(Layout, OfAnAggregateIsThatOfCpp) {
  struct Mixed {
    std::uint8_t a;
    std::array<double, 2> b;
    std::array<std::uint16_t, 3> c;
    std::uint32_t d;
    std::uint8_t e;
  };
  NaturalLayout layout;
  EXPECT_EQ(layout.octets(), 0u);
  EXPECT_EQ(layout.add(Type::Uint8, 1), offsetof(Mixed, a));
  EXPECT_EQ(layout.octets(), 1u);
  EXPECT_EQ(layout.add(Type::Double, 2), offsetof(Mixed, b));
  EXPECT_EQ(layout.add(Type::Uint16, 3), offsetof(Mixed, c));
  EXPECT_EQ(layout.add(Type::Uint32, 1), offsetof(Mixed, d));
  EXPECT_EQ(layout.add(Type::Uint8, 1), offsetof(Mixed, e));
  EXPECT_EQ(layout.octets(), sizeof(Mixed));
  EXPECT_EQ(layout.add(Type::Struct, 1), 37u) << "a structure is its members";
}

TEST(Layout, KnowsWhenOneCopyDoes) {
  const std::array<LayoutField, 2> dense{LayoutField{Type::Double, 2, 0}, LayoutField{Type::Uint32, 2, 16}};
  EXPECT_TRUE(wire_is_native(dense, std::endian::native));
  EXPECT_FALSE(wire_is_native(dense, std::endian::native == std::endian::big ? std::endian::little : std::endian::big));
  EXPECT_FALSE(wire_is_native(fields, std::endian::native));
}

}  // namespace
}  // namespace hirosco
