// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/packet/cuc.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hirosco/pus/testing/vectors.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;

/// Seconds and an exact binary fraction; the vectors have fractions of at most three binary places.
OnboardTime time_of(const nlohmann::json& fields) {
  const double share = fields.at("fraction").get<double>() / std::exp2(8 * fields.at("fine_octets").get<int>());
  return OnboardTime{std::chrono::seconds{fields.at("seconds").get<std::int64_t>()} +
                     Duration{static_cast<std::int64_t>(share * 1e9)}};
}

TEST(Cuc, WritesAndReadsTheVectorsInAllForms) {
  for (const auto& vector : vectors("cuc")) {
    const CucFormat format{vector.fields.at("coarse_octets"), vector.fields.at("fine_octets"),
                           vector.fields.at("p_field"), vector.fields.at("epoch") != "tai"};
    const OnboardTime time = time_of(vector.fields);
    Bytes buffer(20);
    const auto used = write_cuc(buffer, {time, format});
    ASSERT_TRUE(used.has_value()) << vector.id;
    EXPECT_EQ(to_hex(Octets{buffer}.first(*used)), to_hex(vector.octets)) << vector.id;
    if (format.p_field) {
      const auto read = read_cuc(vector.octets);
      ASSERT_TRUE(read.has_value()) << vector.id;
      EXPECT_EQ(read->time, time) << vector.id;
      EXPECT_EQ(read->format, format) << vector.id;
    } else {
      EXPECT_EQ(read_cuc(vector.octets, format).value(), time) << vector.id;
      EXPECT_EQ(from_cuc(vector.octets), time) << vector.id;
      EXPECT_EQ(to_hex(to_cuc(time)), to_hex(vector.octets)) << vector.id;
    }
  }
}

TEST(Cuc, CutsAFractionThatTheCodeCannotHold) {
  // 2^-24 s is 59.6 ns.
  EXPECT_EQ(to_hex(to_cuc(OnboardTime{59ns})), "00000000000000");
  EXPECT_EQ(to_hex(to_cuc(OnboardTime{60ns})), "00000000000001");
  EXPECT_EQ(to_hex(to_cuc(OnboardTime{999'999'999ns})), "00000000ffffff");
}

TEST(Cuc, GivesTheSameOctetsAgainAfterReading) {
  for (std::uint32_t fine = 0; fine < 0x100'0000; fine += 997) {
    Bytes code = from_hex("7fe817a5000000");
    for (int i = 0; i < 3; ++i) code[static_cast<std::size_t>(6 - i)] = static_cast<std::byte>(fine >> 8 * i);
    ASSERT_EQ(to_hex(to_cuc(from_cuc(code))), to_hex(code));
  }
  EXPECT_EQ(to_hex(to_cuc(from_cuc(from_hex("ffffffffffffff")))), "ffffffffffffff");
}

TEST(Cuc, SaturatesOutsideItsRange) {
  EXPECT_EQ(to_hex(to_cuc(OnboardTime{-1s})), "00000000000000");
  EXPECT_EQ(to_hex(to_cuc(OnboardTime::max())), "ffffffffffffff");
}

TEST(Cuc, RefusesWhatIsNotExactlyOneCode) {
  const Bytes whole = from_hex("9f24007fe817a540000000");
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(read_cuc(Octets{whole}.first(length)).has_value()) << length;
  EXPECT_FALSE(read_cuc(from_hex("1f7fe817a500000000")).has_value()) << "one octet too many";
  EXPECT_FALSE(read_cuc(from_hex("407fe817a5000000")).has_value()) << "a day-segmented code";
  EXPECT_FALSE(read_cuc(from_hex("9fa4007fe817a540000000")).has_value()) << "a third P-field octet";
}

TEST(Cuc, DoesNotWriteWhatDoesNotFit) {
  Bytes buffer(6);
  EXPECT_EQ(write_cuc(buffer, {OnboardTime{1s}, {}}).error().code, ErrorCode::ResourceExhausted);
  EXPECT_EQ(write_cuc(buffer, {OnboardTime{256s}, {1, 0, false, false}}).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(write_cuc(buffer, {OnboardTime{1s}, {0, 0, false, false}}).error().code, ErrorCode::InvalidArgument);
}

TEST(RelativeTime, WritesAndReadsTheVectors) {
  for (const auto& vector : vectors("relative_time")) {
    const Duration span = std::chrono::seconds{vector.fields.at("seconds").get<std::int64_t>()} +
                          Duration{vector.fields.at("nanoseconds").get<std::int64_t>()};
    EXPECT_EQ(to_hex(to_relative_cuc(span)), to_hex(vector.octets)) << vector.id;
    EXPECT_EQ(from_relative_cuc(vector.octets), span) << vector.id;
  }
}

TEST(RelativeTime, SaturatesAtTheEndsOfItsField) {
  EXPECT_EQ(to_hex(to_relative_cuc(Duration::max())), "7fffffffffffff");
  EXPECT_EQ(to_hex(to_relative_cuc(Duration::min())), "80000000000000");
}

}  // namespace
}  // namespace hirosco::pus
