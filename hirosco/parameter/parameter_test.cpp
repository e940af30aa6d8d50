// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/parameter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace hirosco {
namespace {

struct Stored {
  std::uint8_t a;
  double b;
  std::array<std::int16_t, 3> c;
};

TEST(Parameter, LoadsWhatWasStored) {
  Parameter<Stored> parameter;
  EXPECT_EQ(parameter.load().b, 0.0);
  parameter.store({7, -2.5, {1, -2, 3}});
  EXPECT_EQ(parameter.load().a, 7);
  EXPECT_EQ(parameter.load().b, -2.5);
  EXPECT_EQ(parameter.load().c, (std::array<std::int16_t, 3>{1, -2, 3}));
}

TEST(Parameter, SnapshotIsTheStoredValue) {
  Parameter<Stored> parameter{{1, 1.5, {4, 5, 6}}};
  Stored seen{};
  ASSERT_TRUE(parameter.snapshot(seen));
  EXPECT_EQ(seen.b, 1.5);
  EXPECT_EQ(seen.c[2], 6);
}

TEST(Parameter, SnapshotRefusesABufferOfAnotherSize) {
  Parameter<std::uint32_t> parameter{5};
  std::array<std::byte, 8> buffer{};
  EXPECT_FALSE(parameter.snapshot(MutableOctets{buffer}.first(3)));
  EXPECT_FALSE(parameter.snapshot(MutableOctets{buffer}));
  EXPECT_TRUE(parameter.snapshot(MutableOctets{buffer}.first(4)));
}

TEST(Parameter, OfASizeThatIsNoMultipleOfAWordIsWhole) {
  Parameter<std::array<std::uint8_t, 13>> parameter;
  std::array<std::uint8_t, 13> value{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
  parameter.store(value);
  std::array<std::uint8_t, 13> seen{};
  ASSERT_TRUE(parameter.snapshot(seen));
  EXPECT_EQ(seen, value);
}

TEST(ParameterCell, EncodesPackedAndBigEndian) {
  Parameter<Stored> parameter{{0x12, 1.0, {0x0102, -2, 3}}};
  const std::vector<std::uint8_t> expected{0x12, 0x3F, 0xF0, 0, 0, 0, 0, 0, 0, 0x01, 0x02, 0xFF, 0xFE, 0x00, 0x03};
  for (const bool live : {true, false}) {
    std::array<std::byte, 15> out{};
    EXPECT_EQ(live ? parameter.encode(parameter.fields(), out) : parameter.snapshot_encode(parameter.fields(), out),
              15u);
    for (std::size_t i = 0; i < out.size(); ++i) EXPECT_EQ(std::to_integer<std::uint8_t>(out[i]), expected[i]) << i;
  }
}

TEST(ParameterCell, RefusesToEncodeIntoTooSmallABuffer) {
  Parameter<Stored> parameter;
  std::array<std::byte, 14> out{};
  EXPECT_EQ(parameter.encode(parameter.fields(), out), 0u);
  EXPECT_EQ(parameter.snapshot_encode(parameter.fields(), out), 0u);
}

TEST(ParameterCell, DecodesWhatItEncodes) {
  Parameter<Stored> source{{9, 3.25, {-1, 2, -3}}};
  Parameter<Stored> target;
  std::array<std::byte, 15> octets{};
  ASSERT_EQ(source.encode(source.fields(), octets), octets.size());
  ASSERT_TRUE(target.stage_encoded(target.fields(), octets));
  EXPECT_EQ(target.load().b, 3.25);
  EXPECT_EQ(target.load().c, source.load().c);
  EXPECT_FALSE(target.stage_encoded(target.fields(), Octets{octets}.first(14)));
}

TEST(ParameterCell, ShowsAStagedChangeOnlyAfterCommit) {
  Parameter<double> parameter{1.0};
  const double two = 2.0;
  parameter.stage(0, std::as_bytes(std::span{&two, 1}));
  double seen = 0.0;
  ASSERT_TRUE(parameter.snapshot(seen));
  EXPECT_EQ(seen, 1.0);
  EXPECT_EQ(parameter.load(), 2.0);
  parameter.commit();
  ASSERT_TRUE(parameter.snapshot(seen));
  EXPECT_EQ(seen, 2.0);
}

TEST(ParameterCell, IgnoresAStageBeyondItsEnd) {
  Parameter<std::uint32_t> parameter{5};
  const std::array<std::byte, 4> octets{};
  parameter.stage(1, octets);
  parameter.stage(~std::size_t{0}, octets);
  EXPECT_EQ(parameter.load(), 5u);
  EXPECT_FALSE(parameter.write_native(Octets{octets}.first(3)));
  EXPECT_TRUE(parameter.write_native(octets));
  EXPECT_EQ(parameter.load(), 0u);
}

// A writer that died in the middle of a store: the reader gives up and says so.
TEST(SequenceLock, ReaderGivesUpWhileAStoreIsUnderWay) {
  std::atomic<parameter_detail::Word> sequence{3};
  int reads = 0;
  EXPECT_FALSE(parameter_detail::read_whole(sequence, ParameterCell::max_attempts, [&] { ++reads; }));
  EXPECT_EQ(reads, 0);
}

TEST(SequenceLock, ReaderRepeatsAReadThatMetAStore) {
  std::atomic<parameter_detail::Word> sequence{4};
  int reads = 0;
  EXPECT_TRUE(parameter_detail::read_whole(sequence, ParameterCell::max_attempts, [&] {
    if (++reads == 1) sequence.store(6);
  }));
  EXPECT_EQ(reads, 2);
}

}  // namespace
}  // namespace hirosco
