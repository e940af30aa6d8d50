// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/downlink/downlink.hpp"

#include <gtest/gtest.h>

#include <array>

namespace hirosco::ground {
namespace {

constexpr OnboardTime stamped_at{std::chrono::seconds{2'145'916'900}};

std::vector<std::byte> packet(std::uint16_t count, OnboardTime t, std::uint16_t apid = 10) {
  std::array<std::byte, 64> buffer;
  const std::array<std::byte, 3> data{};
  const auto written = pus::write_telemetry(
      buffer, {.apid = apid, .sequence_count = count, .service = 5, .subtype = 1, .time = t}, data);
  EXPECT_TRUE(written);
  return {written->begin(), written->end()};
}

class ADownlink : public ::testing::Test {
 protected:
  std::vector<std::uint16_t> counts;
  std::vector<std::pair<OnboardTime, OnboardTime>> gaps;
  Downlink link{{.packet = [this](const pus::TelemetryView& one, Octets) { counts.push_back(one.sequence_count()); },
                 .gap = [this](OnboardTime from, OnboardTime to) { gaps.emplace_back(from, to); }}};
};

TEST_F(ADownlink, MakesPacketsOfOctetsThatComeOneByOne) {
  link.begin({});
  for (std::uint16_t count = 0; count < 3; ++count)
    for (const std::byte octet : packet(count, stamped_at)) ASSERT_TRUE(link.receive(Octets{&octet, 1}));
  EXPECT_EQ(counts, (std::vector<std::uint16_t>{0, 1, 2}));
  EXPECT_TRUE(gaps.empty());
}

TEST_F(ADownlink, TellsWhatIsMissingOfEachApidBeforeThePacketBehindIt) {
  link.begin({});
  ASSERT_TRUE(link.receive(packet(16'383, stamped_at)));
  ASSERT_TRUE(link.receive(packet(7, stamped_at, 11)));
  ASSERT_TRUE(link.receive(packet(2, stamped_at + 1s)));
  ASSERT_TRUE(link.receive(packet(8, stamped_at + 1s, 11)));
  EXPECT_EQ(link.lost(), 2U);  // 0 and 1
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0], std::pair(stamped_at, stamped_at + 1s));
}

TEST_F(ADownlink, OfASourceThatBeganAgainNothingWasLost) {
  link.begin({});
  ASSERT_TRUE(link.receive(packet(5000, stamped_at)));
  ASSERT_TRUE(link.receive(packet(0, stamped_at + 1s)));
  EXPECT_EQ(link.lost(), 0U);
  EXPECT_TRUE(gaps.empty());
}

TEST_F(ADownlink, TheTimeBetweenTwoStreamsIsOneGap) {
  link.begin(stamped_at - 60s);
  ASSERT_TRUE(link.receive(packet(100, stamped_at)));
  ASSERT_TRUE(link.receive(packet(101, stamped_at + 1s)));
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0], std::pair(stamped_at - 60s, stamped_at));
  EXPECT_EQ(link.lost(), 0U);
}

TEST_F(ADownlink, CountsADamagedPacketAndGoesOnBehindIt) {
  link.begin({});
  auto bad = packet(0, stamped_at);
  bad.back() ^= std::byte{1};
  ASSERT_TRUE(link.receive(bad));
  ASSERT_TRUE(link.receive(packet(1, stamped_at)));
  EXPECT_EQ(link.damaged(), 1U);
  EXPECT_EQ(counts, std::vector<std::uint16_t>{1});
}

TEST_F(ADownlink, WhatIsNoTelemetryEndsIt) {
  link.begin({});
  const std::vector<std::byte> junk(64, std::byte{0xFF});
  EXPECT_FALSE(link.receive(junk));
  link.begin({});
  EXPECT_TRUE(link.receive(packet(0, stamped_at)));
  EXPECT_EQ(counts.size(), 1U);
}

}  // namespace
}  // namespace hirosco::ground
