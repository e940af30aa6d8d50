// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/wire_values.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace hirosco::descriptor {
namespace {

template <class T>
std::vector<std::byte> octets(std::initializer_list<T> values) {
  std::vector<std::byte> written(values.size() * sizeof(T));
  OctetWriter writer{written};
  for (const T value : values) writer.put(value);
  return written;
}

Field field(Type type, std::uint32_t count = 1) {
  Field made;
  made.type = type;
  made.count = count;
  return made;
}

TEST(WireValues, AreTheNumbersInTheirOrder) {
  EXPECT_EQ(values_within(field(Type::Int16, 3), octets<std::int16_t>({-5, 0, 7})),
            (std::vector<Value>{Number{-5}, Number{0}, Number{7}}));
  EXPECT_EQ(values_within(field(Type::Double), octets({0.1})), (std::vector<Value>{Number{0.1}}));
}

TEST(WireValues, OfAnotherLengthAreNone) {
  EXPECT_FALSE(values_within(field(Type::Int16, 2), octets<std::int16_t>({1})));
  EXPECT_FALSE(values_within(field(Type::Int16), octets<std::int16_t>({1, 2})));
}

TEST(WireValues, OutsideTheRangeAreNoneAndItsEndsAreInside) {
  Field ranged = field(Type::Double, 2);
  ranged.minimum = Number{-1};
  ranged.maximum = Number{2};
  EXPECT_TRUE(values_within(ranged, octets({-1.0, 2.0})));
  EXPECT_FALSE(values_within(ranged, octets({-1.0, std::nextafter(2.0, 3.0)})));
  EXPECT_FALSE(values_within(ranged, octets({std::nextafter(-1.0, -2.0), 2.0})));
}

TEST(WireValues, WhatIsNoNumberOrHasNoEndIsNone) {
  EXPECT_FALSE(values_within(field(Type::Double), octets({std::numeric_limits<double>::quiet_NaN()})));
  EXPECT_FALSE(values_within(field(Type::Double), octets({std::numeric_limits<double>::infinity()})));
}

TEST(WireValues, ASwitchIsOnOrOff) {
  EXPECT_TRUE(values_within(field(Type::Bool), octets<std::uint8_t>({1})));
  EXPECT_FALSE(values_within(field(Type::Bool), octets<std::uint8_t>({2})));
}

TEST(WireValues, WordsAreUtf8WithZerosBehind) {
  Field words = field(Type::Text);
  words.text_octets = 4;
  const auto text = [](std::array<unsigned char, 4> letters) {
    return octets<std::uint8_t>({letters[0], letters[1], letters[2], letters[3]});
  };
  EXPECT_EQ(values_within(words, text({'a', 'b', 0, 0})), (std::vector<Value>{std::string{"ab"}}));
  EXPECT_FALSE(values_within(words, text({'a', 0, 'b', 0})));
  EXPECT_FALSE(values_within(words, text({0xC3, 0, 0, 0})));
}

}  // namespace
}  // namespace hirosco::descriptor
