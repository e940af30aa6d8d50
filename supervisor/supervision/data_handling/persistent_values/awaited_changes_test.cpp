// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/persistent_values/awaited_changes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint16_t winch = 10, lift = 11, ground = 7;

struct AwaitedChangesTest : ::testing::Test {
  AwaitedChanges awaited;
  std::array<std::byte, 64> buffer{};

  [[nodiscard]] pus::TelemetryView end(std::uint32_t request, std::uint16_t destination = ground) {
    std::array<std::byte, 4> data{};
    OctetWriter{data}.put(request);
    const auto packet =
        pus::write_telemetry(buffer, {.apid = winch, .service = 1, .subtype = 7, .destination = destination}, data);
    return pus::TelemetryView::parse(*packet).value();
  }
};

TEST_F(AwaitedChangesTest, EndWithTheReportOfWhoWasAskedToWhoAsked) {
  ASSERT_TRUE(awaited.add({winch, 5, ground, {1, 2}, {std::byte{9}}}));
  EXPECT_FALSE(awaited.take(lift, end(5)));
  EXPECT_FALSE(awaited.take(winch, end(6)));
  EXPECT_FALSE(awaited.take(winch, end(5, 8)));
  const auto ended = awaited.take(winch, end(5));
  ASSERT_TRUE(ended);
  EXPECT_THAT(ended->ids, ElementsAre(1, 2));
  EXPECT_FALSE(awaited.take(winch, end(5)));
}

TEST_F(AwaitedChangesTest, OneThatWasToldAsUnknownIsAwaitedOn) {
  ASSERT_TRUE(awaited.add({winch, 5, ground, {1}}));
  ASSERT_NE(awaited.told_as_unknown(end(5)), nullptr);
  EXPECT_EQ(awaited.told_as_unknown(end(6)), nullptr);
  EXPECT_TRUE(awaited.take(winch, end(5)));
}

TEST_F(AwaitedChangesTest, OfWhoDiesWhatFunctionsMayHaveChangedIsLeft) {
  ASSERT_TRUE(awaited.add({winch, 5, ground, {1}}));
  ASSERT_TRUE(awaited.add({winch, 6, ground, {2}, {std::byte{9}}}));
  ASSERT_TRUE(awaited.add({lift, 7, ground, {3}}));
  EXPECT_THAT(awaited.take_all_of(winch), ElementsAre(1));
  EXPECT_THAT(awaited.take_all_of(winch), IsEmpty());
  EXPECT_THAT(awaited.take_all_of(lift), ElementsAre(3));
}

TEST_F(AwaitedChangesTest, TheNextSupervisorAwaitsThem) {
  ASSERT_TRUE(awaited.add({winch, 5, ground, {1, 2}, {std::byte{9}, std::byte{8}}}));
  ASSERT_TRUE(awaited.add({lift, 7, ground, {3}}));
  std::vector<std::byte> noted(256);
  OctetWriter writer{noted};
  awaited.note(writer);
  AwaitedChanges next;
  OctetReader reader{writer.written()};
  next.recall(reader);
  EXPECT_TRUE(reader.exhausted());
  EXPECT_THAT(next.take(winch, end(5))->values, ElementsAre(std::byte{9}, std::byte{8}));
  EXPECT_THAT(next.take_all_of(lift), ElementsAre(3));
}

TEST_F(AwaitedChangesTest, HaveRoomForSoManyAndAreNotedInSoManyOctets) {
  for (std::uint32_t i = 0; i < AwaitedChanges::most; ++i) ASSERT_TRUE(awaited.add({winch, i, ground, {1}}));
  EXPECT_FALSE(awaited.add({winch, 999, ground, {1}}));
  AwaitedChanges long_ones;
  std::uint32_t taken = 0;
  const std::vector<std::byte> values(pus::max_telecommand_octets);
  while (long_ones.add({winch, taken, ground, {1}, values})) ++taken;
  EXPECT_GT(taken, 0U);
  std::vector<std::byte> noted(AwaitedChanges::most_octets + sizeof(std::uint16_t));
  OctetWriter writer{noted};
  long_ones.note(writer);
  EXPECT_TRUE(writer.good());
}

}  // namespace
}  // namespace hirosco::supervisor
