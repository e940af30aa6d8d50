// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/telecommand_copy.hpp"

#include <gtest/gtest.h>

#include "hirosco/pus/testing/recording_sink.hpp"

namespace hirosco::supervisor {
namespace {

std::vector<std::byte> of_octets(std::size_t octets) { return std::vector<std::byte>(octets, std::byte{0x5A}); }

TEST(TelecommandCopy, IsTheWholePacketToEveryGround) {
  pus::testing::RecordingSink sink;
  const auto packet = of_octets(20);
  send_telecommand_copy(sink, packet);
  ASSERT_EQ(sink.reports.size(), 1u);
  EXPECT_EQ(sink.reports[0].service, 129);
  EXPECT_EQ(sink.reports[0].subtype, 3);
  EXPECT_EQ(sink.reports[0].destination, 0);
  EXPECT_EQ(sink.reports[0].data, packet);
}

TEST(TelecommandCopy, OneThatFitsIntoAPacketToTheLastOctetIsToldAndOneThatDoesNotIsNot) {
  constexpr std::size_t most = pus::max_telemetry_octets - pus::telemetry_overhead_octets;
  pus::testing::RecordingSink sink;
  send_telecommand_copy(sink, of_octets(most + 1));
  EXPECT_TRUE(sink.reports.empty());
  send_telecommand_copy(sink, of_octets(most));
  ASSERT_EQ(sink.reports.size(), 1u);
  std::vector<std::byte> packet(pus::max_telemetry_octets);
  EXPECT_TRUE(pus::write_telemetry(packet, {.apid = 1, .service = 129, .subtype = 3}, sink.reports[0].data));
}

}  // namespace
}  // namespace hirosco::supervisor
