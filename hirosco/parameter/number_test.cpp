// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/number.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace hirosco {
namespace {

double through(Type type, double value) {
  std::array<std::byte, 8> octets{};
  OctetWriter writer{octets};
  put_number(writer, type, value);
  EXPECT_EQ(writer.size(), type == Type::Text ? 0 : octets_of(type)) << "words are no number";
  OctetReader reader{writer.written()};
  return get_number(reader, type);
}

TEST(Number, GoesThroughEveryTypeUnchanged) {
  for (const auto& row : EnumTexts<Type>::table) {
    const bool none = row.value == Type::Struct || row.value == Type::Text;
    EXPECT_EQ(through(row.value, 100.0), none ? 0.0 : row.value == Type::Bool ? 1.0 : 100.0) << row.text;
  }
}

TEST(Number, IsHeldAtTheEndsOfItsType) {
  EXPECT_EQ(through(Type::Uint8, 256.0), 255.0);
  EXPECT_EQ(through(Type::Uint8, -1.0), 0.0);
  EXPECT_EQ(through(Type::Int16, -1e9), -32768.0);
  EXPECT_EQ(through(Type::Int64, 1e30), 0x1p63);
  EXPECT_EQ(through(Type::Uint64, 1e30), 0x1p64);
  EXPECT_EQ(through(Type::Int32, std::numeric_limits<double>::quiet_NaN()), 0.0);
}

}  // namespace
}  // namespace hirosco
