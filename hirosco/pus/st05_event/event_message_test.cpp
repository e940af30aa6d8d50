// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st05_event/event_message.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace hirosco::pus {
namespace {
using descriptor::Severity;

std::vector<std::byte> octets_of(std::initializer_list<int> values) {
  std::vector<std::byte> octets;
  for (const int value : values) octets.push_back(static_cast<std::byte>(value));
  return octets;
}

TEST(EventMessage, HasTheDocumentedOctets) {
  const auto auxiliary = octets_of({0xAA, 0xBB});
  std::array<std::byte, 16> buffer{};
  const auto written = write_event_message(
      buffer, {.severity = Severity::High, .reported = Reported::No, .id = 0xF101, .auxiliary = auxiliary});
  ASSERT_TRUE(written);
  EXPECT_TRUE(std::ranges::equal(*written, octets_of({4, 0, 0xF1, 0x01, 0xAA, 0xBB})));
}

TEST(EventMessage, ComesBackAsItWasWrittenForEverySeverityAndLength) {
  std::array<std::byte, 512> buffer{};
  for (const auto& row : EnumTexts<Severity>::table)
    for (const Reported reported : {Reported::No, Reported::Yes})
      for (std::size_t octets = 0; octets <= buffer.size() - event_message_head_octets; octets += 127) {
        const std::vector<std::byte> auxiliary(octets, std::byte{0x5A});
        const auto written = write_event_message(buffer, {row.value, reported, 1, auxiliary});
        ASSERT_TRUE(written);
        const auto read = read_event_message(*written);
        ASSERT_TRUE(read);
        EXPECT_EQ(read->severity, row.value);
        EXPECT_EQ(read->reported, reported);
        EXPECT_EQ(read->id, 1);
        EXPECT_TRUE(std::ranges::equal(read->auxiliary, auxiliary));
      }
}

TEST(EventMessage, ThatDoesNotFitIsRefusedAndNothingIsWrittenBeyondTheBuffer) {
  std::array<std::byte, 8> buffer{};
  const std::vector<std::byte> auxiliary(4);
  for (std::size_t room = 0; room < buffer.size(); ++room) {
    buffer.fill(std::byte{0xEE});
    EXPECT_FALSE(write_event_message(MutableOctets{buffer}.first(room), {Severity::Low, Reported::Yes, 7, auxiliary}));
    EXPECT_TRUE(std::ranges::all_of(MutableOctets{buffer}.subspan(room), [](auto o) { return o == std::byte{0xEE}; }));
  }
}

TEST(EventMessage, CutOffAnywhereInItsHeadIsRefused) {
  const auto whole = octets_of({3, 1, 0x12, 0x34});
  for (std::size_t octets = 0; octets < whole.size(); ++octets)
    EXPECT_FALSE(read_event_message(Octets{whole}.first(octets))) << octets;
  EXPECT_TRUE(read_event_message(whole));
}

TEST(EventMessage, WithAFieldOutsideItsRangeIsRefused) {
  for (int value = 0; value < 256; ++value) {
    EXPECT_EQ(read_event_message(octets_of({value, 1, 0, 1})).has_value(), value >= 1 && value <= 4) << value;
    EXPECT_EQ(read_event_message(octets_of({1, value, 0, 1})).has_value(), value <= 1) << value;
  }
  EXPECT_FALSE(read_event_message(octets_of({1, 1, 0, 0}))) << "there is no event 0";
}

TEST(EventMessage, OfRandomOctetsIsEitherRefusedOrComesBackTheSame) {
  std::minstd_rand random{20260101};
  int taken = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::vector<std::byte> octets(random() % 40);
    // Small values, so that not everything is refused at its first field.
    for (auto& octet : octets) octet = static_cast<std::byte>(random() % 6);
    const auto event = read_event_message(octets);
    if (!event) continue;
    ++taken;
    std::array<std::byte, 64> buffer{};
    EXPECT_TRUE(std::ranges::equal(write_event_message(buffer, *event).value(), octets));
  }
  EXPECT_GT(taken, 100);
}

}  // namespace
}  // namespace hirosco::pus
