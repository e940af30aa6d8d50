// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/exact_number.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace hirosco {
namespace {

constexpr std::int64_t least = INT64_MIN;
constexpr std::uint64_t most = UINT64_MAX;

TEST(ExactNumber, IsOrderedWithoutRoundingAnything) {
  const double two_to_53 = 9007199254740992.0, two_to_63 = 9223372036854775808.0, two_to_64 = 18446744073709551616.0;
  const std::vector<Number> ascending{-1e300,
                                      least,
                                      least + 1,
                                      -two_to_53,
                                      -1.5,
                                      -1,
                                      -0.5,
                                      0,
                                      0.5,
                                      1,
                                      1.5,
                                      two_to_53,
                                      std::int64_t{9007199254740993},
                                      INT64_MAX,
                                      two_to_63,
                                      std::uint64_t{9223372036854775809U},
                                      most,
                                      two_to_64,
                                      1e300};
  for (std::size_t i = 0; i < ascending.size(); ++i)
    for (std::size_t j = 0; j < ascending.size(); ++j) {
      EXPECT_EQ(ascending[i] < ascending[j], i < j) << i << " " << j;
      EXPECT_EQ(ascending[i] == ascending[j], i == j) << i << " " << j;
    }
}

TEST(ExactNumber, IsTheSameFromWhateverTypeItCame) {
  EXPECT_EQ(Number{5.0}, Number{5});
  EXPECT_EQ(Number{-5.0}, Number{std::int8_t{-5}});
  EXPECT_EQ(Number{-0.0}, Number{0});
  EXPECT_EQ(Number{true}, Number{1});
  EXPECT_EQ(Number{-9223372036854775808.0}, Number{least});
  const Number none{std::numeric_limits<double>::quiet_NaN()};
  EXPECT_FALSE(none == none);
  EXPECT_FALSE(none < Number{0} || none > Number{0});
  EXPECT_FALSE(none.is_finite());
}

TEST(ExactNumber, BecomesOnlyAnIntegerThatHasIt) {
  EXPECT_EQ(Number{255}.as<std::uint8_t>(), std::uint8_t{255});
  EXPECT_EQ(Number{256}.as<std::uint8_t>(), std::nullopt);
  EXPECT_EQ(Number{-1}.as<std::uint64_t>(), std::nullopt);
  EXPECT_EQ(Number{most}.as<std::int64_t>(), std::nullopt);
  EXPECT_EQ(Number{least}.as<std::int64_t>(), least);
  EXPECT_EQ(Number{1.5}.as<int>(), std::nullopt);
  EXPECT_EQ(Number{2}.as<bool>(), std::nullopt);
}

struct End {
  Type type;
  Number lowest;
  Number highest;
  Number below;
  Number above;
};

TEST(ExactNumber, IsWrittenAtBothEndsOfEveryTypeAndNotBeyond) {
  const End ends[]{
      {Type::Bool, 0, 1, -1, 2},
      {Type::Uint8, 0, 255, -1, 256},
      {Type::Int8, -128, 127, -129, 128},
      {Type::Uint16, 0, 65'535, -1, 65'536},
      {Type::Int16, -32'768, 32'767, -32'769, 32'768},
      {Type::Uint32, 0, 4'294'967'295U, -1, std::int64_t{4'294'967'296}},
      {Type::Int32, std::int64_t{-2'147'483'648}, 2'147'483'647, std::int64_t{-2'147'483'649},
       std::int64_t{2'147'483'648}},
      {Type::Uint64, 0, most, -1, 18446744073709551616.0},
      {Type::Int64, least, INT64_MAX, -9223372036854777856.0, std::uint64_t{9223372036854775808U}},
  };
  for (const End& end : ends) {
    const auto through = [&](const Number& number) -> std::optional<Number> {
      std::array<std::byte, 8> octets{};
      OctetWriter writer{octets};
      if (!write_number(writer, end.type, number)) {
        EXPECT_EQ(writer.size(), 0U);
        return std::nullopt;
      }
      EXPECT_EQ(writer.size(), octets_of(end.type));
      OctetReader reader{writer.written()};
      return read_number(reader, end.type);
    };
    const auto text = to_text(end.type);
    EXPECT_EQ(through(end.lowest), end.lowest) << text;
    EXPECT_EQ(through(end.highest), end.highest) << text;
    EXPECT_EQ(through(end.below), std::nullopt) << text;
    EXPECT_EQ(through(end.above), std::nullopt) << text;
    EXPECT_EQ(through(0.5), std::nullopt) << text;
    EXPECT_EQ(range_of(end.type).lowest, end.lowest) << text;
    EXPECT_EQ(range_of(end.type).highest, end.highest) << text;
  }
}

TEST(ExactNumber, KeepsTheSignOfMinusZeroAndRoundsToAFloat) {
  std::array<std::byte, 12> octets{};
  OctetWriter writer{octets};
  EXPECT_TRUE(write_number(writer, Type::Double, -0.0));
  EXPECT_TRUE(write_number(writer, Type::Float, 0.1));
  EXPECT_EQ(octets[0], std::byte{0x80});
  OctetReader reader{Octets{octets}.subspan(8)};
  EXPECT_EQ(reader.get<float>(), 0.1F);
  OctetWriter again{octets};
  EXPECT_FALSE(write_number(again, Type::Float, 1e39));
}

TEST(ExactNumber, IsReadBackFromItsText) {
  for (const char* text : {"0", "-1", "18446744073709551615", "-9223372036854775808", "9007199254740993", "0.1", "-2.5",
                           "1e+300", "5e-324"}) {
    const auto number = parse_number(text);
    ASSERT_TRUE(number) << text;
    EXPECT_EQ(to_string(*number), text);
  }
  EXPECT_EQ(parse_number("+7"), Number{7});
  EXPECT_EQ(parse_number("1e3"), Number{1000});
  EXPECT_EQ(parse_number("18446744073709551616"), Number{18446744073709551616.0}) << "beyond 64 bits a double";
  EXPECT_LT(*parse_number("-9223372036854775809"), Number{least}) << "not rounded into the range";
  for (const char* text : {"", " 1", "1 ", "1x", "0x1", "nan", "inf", "+-1", "--1", "1e999"})
    EXPECT_EQ(parse_number(text), std::nullopt) << text;
}

}  // namespace
}  // namespace hirosco
