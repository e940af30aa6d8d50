// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/traffic.hpp"

#include <gtest/gtest.h>

#include <array>
#include <initializer_list>
#include <numeric>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::supervisor {
namespace {

struct TrafficTest : ::testing::Test {
  Traffic traffic;
  /// TM[1,subtype] with these octets behind the request.
  void hear(std::uint8_t subtype, std::initializer_list<int> behind_request, std::uint8_t service = 1) {
    std::vector<std::byte> data(4);
    for (const int octet : behind_request) data.push_back(static_cast<std::byte>(octet));
    std::array<std::byte, 64> buffer;
    const auto packet = pus::write_telemetry(buffer, {.apid = 10, .service = service, .subtype = subtype}, data);
    ASSERT_TRUE(packet);
    traffic.hear(10, pus::TelemetryView::parse(*packet).value());
  }
  [[nodiscard]] std::uint32_t all() const {
    return std::accumulate(traffic.rejections().begin(), traffic.rejections().end(), 0U);
  }
};

TEST_F(TrafficTest, EveryFailureReportCountsByItsCode) {
  for (const int subtype : {2, 4, 8, 10}) hear(static_cast<std::uint8_t>(subtype), {0, subtype});
  hear(2, {0, 2});
  EXPECT_EQ(traffic.rejections()[2], 2U);
  for (const std::size_t code : {4U, 8U, 10U}) EXPECT_EQ(traffic.rejections()[code], 1U) << code;
  EXPECT_EQ(all(), 5U);
}

TEST_F(TrafficTest, InAFailureOfAStepTheNumberOfTheStepStandsBeforeTheCode) {
  hear(6, {0, 3, 0, 5});
  EXPECT_EQ(traffic.rejections()[5], 1U);
  EXPECT_EQ(all(), 1U);
}

TEST_F(TrafficTest, TheCodesOfServicesAndAuthorsShareTheFirstPlace) {
  hear(2, {0, 18});
  hear(8, {1, 1});
  hear(8, {2, 0});
  EXPECT_EQ(traffic.rejections()[18], 1U);
  EXPECT_EQ(traffic.rejections()[0], 2U);
}

TEST_F(TrafficTest, WhatIsNoFailureOrEndsTooEarlyIsNotCounted) {
  hear(1, {0, 2});
  hear(7, {0, 2});
  hear(2, {0, 2}, 5);
  hear(2, {0});
  hear(6, {0, 1});
  EXPECT_EQ(all(), 0U);
}

}  // namespace
}  // namespace hirosco::supervisor
