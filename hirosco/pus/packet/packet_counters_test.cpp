// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/packet/packet_counters.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace hirosco::pus {
namespace {

TelemetryHeader stamped(PacketCounters& counters, std::uint8_t service, std::uint8_t subtype,
                        std::uint16_t destination = 0) {
  TelemetryHeader header;
  header.service = service;
  header.subtype = subtype;
  header.destination = destination;
  counters.stamp(header);
  return header;
}

TEST(PacketCounters, CountPacketsOfAllTypesTogetherFromZeroAndWrapAtFourteenBits) {
  CounterBlock block{};
  PacketCounters counters{block};
  for (unsigned i = 0; i < 16384 + 3; ++i)
    ASSERT_EQ(stamped(counters, 17, static_cast<std::uint8_t>(i % 5)).sequence_count, i % 16384);
}

TEST(PacketCounters, CountEachDestinationServiceAndSubtypeByItself) {
  CounterBlock block{};
  PacketCounters counters{block};
  EXPECT_EQ(stamped(counters, 1, 1, 0).message_count, 0);
  EXPECT_EQ(stamped(counters, 1, 1, 0).message_count, 1);
  EXPECT_EQ(stamped(counters, 1, 1, 7).message_count, 0) << "another destination";
  EXPECT_EQ(stamped(counters, 1, 7, 0).message_count, 0) << "another subtype";
  EXPECT_EQ(stamped(counters, 3, 1, 0).message_count, 0) << "another service";
  EXPECT_EQ(stamped(counters, 1, 1, 0).message_count, 2);
}

TEST(PacketCounters, WrapMessageCountsAtSixteenBits) {
  CounterBlock block{};
  PacketCounters counters{block};
  for (unsigned i = 0; i <= 65535; ++i) ASSERT_EQ(stamped(counters, 3, 25).message_count, i);
  EXPECT_EQ(stamped(counters, 3, 25).message_count, 0);
}

TEST(PacketCounters, SayUnsupportedForTypesBeyondTheTable) {
  CounterBlock block{};
  PacketCounters counters{block};
  for (int round = 0; round < 3; ++round)
    for (unsigned subtype = 0; subtype < 66; ++subtype)
      EXPECT_EQ(stamped(counters, 200, static_cast<std::uint8_t>(subtype)).message_count, subtype < 64 ? round : 0);
}

TEST(PacketCounters, GoOnFromTheBlockOfAnEarlierProcess) {
  CounterBlock block{};
  {
    PacketCounters before{block};
    stamped(before, 3, 25);
    stamped(before, 3, 25);
  }
  PacketCounters after{block};
  const auto header = stamped(after, 3, 25);
  EXPECT_EQ(header.sequence_count, 2);
  EXPECT_EQ(header.message_count, 2);
}

TEST(PacketCounters, SurviveABlockOfGarbage) {
  CounterBlock block;
  std::memset(&block, 0xFF, sizeof block);
  PacketCounters counters{block};
  for (int i = 0; i < 100; ++i) EXPECT_LT(stamped(counters, 1, static_cast<std::uint8_t>(i)).sequence_count, 16384);
}

}  // namespace
}  // namespace hirosco::pus
