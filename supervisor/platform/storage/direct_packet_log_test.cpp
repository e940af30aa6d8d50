// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "supervisor/platform/storage/packet_log.hpp"
#include "supervisor/platform/storage/testing/test_databases.hpp"

namespace hirosco::supervisor {
namespace {

TEST(DirectPacketLog, IsDurableAtOnce) {
  ManualClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  DirectPacketLog log{clock, std::make_unique<Shared>(memory)};
  clock.advance(3s);
  EXPECT_EQ(log.append(telecommand()), 1U);
  EXPECT_EQ(log.durable(), 1U);
  const auto records = all_of(*memory);
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].monotonic, clock.now());
  EXPECT_EQ(records[0].stored, clock.onboard());
  EXPECT_EQ(records[0].run + 3s, records[0].stored);
}

TEST(DirectPacketLog, KeepsWhatAFailedDatabaseDidNotTakeForTheNext) {
  const ManualClock clock;
  auto first = std::make_shared<MemoryDatabase>();
  auto second = std::make_shared<MemoryDatabase>();
  DirectPacketLog log{clock,
                      std::make_unique<BreakingDatabase>(1, first),
                      {.telemetry_records = 2, .telemetry_octets = 10, .vital_records = 8, .vital_octets = 10}};
  for (int i = 0; i < 6; ++i) ASSERT_NE(log.append(telemetry()), 0U);
  EXPECT_EQ(log.durable(), 1U);
  EXPECT_TRUE(log.failure());
  log.switch_to(std::make_unique<Shared>(second));
  EXPECT_EQ(log.durable(), 6U);
  auto all = all_of(*first);
  const auto rest = all_of(*second);
  all.insert(all.end(), rest.begin(), rest.end());
  expect_complete(all, 6);
  EXPECT_EQ(log.counters().lost, 2U);
  EXPECT_EQ(log.counters().accepted, 4U) << "what was pushed out counts as lost only";
}

TEST(DirectPacketLog, ClosesAWorkingDatabaseWithASwitchedRecord) {
  const ManualClock clock;
  auto first = std::make_shared<MemoryDatabase>();
  auto second = std::make_shared<MemoryDatabase>();
  DirectPacketLog log{clock, std::make_unique<Shared>(first)};
  ASSERT_EQ(log.append(telecommand()), 1U);
  log.switch_to(std::make_unique<Shared>(second));
  ASSERT_EQ(log.append(telecommand()), 3U);
  EXPECT_EQ(all_of(*first).back().kind, LogKind::Switched);
  EXPECT_EQ(all_of(*second).size(), 1U);
}

TEST(DirectPacketLog, CountsWhatItTookLostRefusedStoredAndSwitched) {
  const ManualClock clock;
  auto hold = std::make_shared<HeldDatabase::Hold>();
  auto memory = std::make_shared<MemoryDatabase>();
  hold->tries = 4;
  DirectPacketLog log{clock,
                      std::make_unique<HeldDatabase>(hold, memory),
                      {.telemetry_records = 2, .telemetry_octets = 10, .vital_records = 8, .vital_octets = 10}};
  const std::vector<std::byte> long_packet(11);
  for (int i = 0; i < 3; ++i) ASSERT_NE(log.append(telemetry()), 0U);
  EXPECT_EQ(log.append({.kind = LogKind::TelecommandReceived, .packet = long_packet}), 0U);
  EXPECT_EQ(log.durable(), 0U);
  EXPECT_FALSE(log.failure()) << "held is not failed";
  EXPECT_EQ(log.counters().batches, 0U);
  ASSERT_EQ(log.append(telecommand()), 5U);
  EXPECT_EQ(log.durable(), 5U);
  expect_complete(all_of(*memory), 5);
  log.switch_to(std::make_unique<BreakingDatabase>(0, memory));
  EXPECT_EQ(all_of(*memory).back().note, Note{"the log goes on in: breaking"});
  ASSERT_EQ(log.append(telecommand()), 7U);
  EXPECT_TRUE(log.failure());
  const LogCounters counters = log.counters();
  EXPECT_EQ(counters.accepted, 6U);
  EXPECT_EQ(counters.lost, 0U);
  EXPECT_EQ(counters.refused, 1U);
  EXPECT_EQ(counters.durable, 6U);
  EXPECT_EQ(counters.batches, 3U);
  EXPECT_EQ(counters.failures, 1U);
  EXPECT_EQ(counters.switches, 1U);
}

TEST(DirectPacketLog, ADatabaseInTroubleIsAFailureAsLongAsItIs) {
  const ManualClock clock;
  auto hold = std::make_shared<HeldDatabase::Hold>();
  DirectPacketLog log{clock, std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>())};
  EXPECT_FALSE(log.failure());
  hold->troubles = 1;
  ASSERT_TRUE(log.failure());
  EXPECT_EQ(log.failure()->value, ENOSPC);
  hold->troubles = 0;
  EXPECT_FALSE(log.failure());
}

}  // namespace
}  // namespace hirosco::supervisor
