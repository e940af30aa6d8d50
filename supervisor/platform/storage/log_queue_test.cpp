// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/log_queue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;

std::vector<LogRecord> take_all(LogQueue& queue) {
  std::vector<LogRecord> all;
  LogBatch batch{3};
  while (!queue.empty()) {
    queue.take(batch);
    all.insert(all.end(), batch.records().begin(), batch.records().end());
    batch.clear();
  }
  return all;
}

std::vector<std::uint64_t> numbers(const std::vector<LogRecord>& records) {
  std::vector<std::uint64_t> all;
  for (const LogRecord& one : records) all.push_back(one.number);
  return all;
}

LogEntry queued_telemetry(Octets packet = {}) { return {.kind = LogKind::Telemetry, .packet = packet}; }
LogEntry queued_telecommand() { return {.kind = LogKind::TelecommandReceived, .packet = {}}; }

std::uint64_t push(LogQueue& queue, const LogEntry& entry) { return queue.push(entry, {}, {}); }

TEST(LogQueue, GivesRecordsBackInTheOrderOfTheirNumbers) {
  LogQueue queue{{}, OnboardTime{5s}};
  EXPECT_EQ(push(queue, queued_telemetry()), 1U);
  EXPECT_EQ(push(queue, queued_telecommand()), 2U);
  EXPECT_EQ(push(queue, queued_telemetry()), 3U);
  EXPECT_EQ(push(queue, queued_telecommand()), 4U);
  const auto all = take_all(queue);
  EXPECT_THAT(numbers(all), ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(all[0].run, OnboardTime{5s});
}

TEST(LogQueue, GivesBackAllThatARecordWasMadeOfThoughItsPlaceInTheBatchWasUsedBefore) {
  LogQueue queue{{.telemetry_records = 1, .telemetry_octets = 100, .vital_records = 8, .vital_octets = 100},
                 OnboardTime{5s}};
  LogBatch batch{1};
  const std::array packet{std::byte{1}, std::byte{2}, std::byte{3}};
  const LogEntry entry{
      .kind = LogKind::TelecommandRefused, .source = 11, .peer = 12, .packet = packet, .note = Note{"why"}};
  const LogRecord wanted{.run = OnboardTime{5s},
                         .number = 1,
                         .stored = OnboardTime{7s},
                         .monotonic = TimePoint{2s},
                         .kind = entry.kind,
                         .source = 11,
                         .peer = 12,
                         .note = entry.note,
                         .packet = {packet.begin(), packet.end()}};
  queue.push(entry, wanted.stored, wanted.monotonic);
  queue.take(batch);
  EXPECT_EQ(batch.records().front(), wanted);
  batch.clear();
  queue.push(queued_telemetry(), OnboardTime{8s}, TimePoint{3s});
  queue.push(queued_telemetry(), OnboardTime{9s}, TimePoint{4s});
  queue.take(batch);
  EXPECT_EQ(batch.records().front(), (LogRecord{.run = OnboardTime{5s},
                                                .number = 2,
                                                .stored = OnboardTime{8s},
                                                .monotonic = TimePoint{3s},
                                                .kind = LogKind::Gap,
                                                .lost = 1,
                                                .note = Note{"no room before the database, up to number 2"}}));
  batch.clear();
  queue.take(batch);
  EXPECT_EQ(batch.records().front().lost, 0U);
  EXPECT_TRUE(queue.empty());
}

TEST(LogQueue, AGapBeginsWithTheOldestThatIsMissingThoughALaterOneWasRefusedBefore) {
  LogQueue queue{{.telemetry_records = 1, .telemetry_octets = 10, .vital_records = 8, .vital_octets = 10}, {}};
  const std::vector<std::byte> long_packet(11);
  queue.push(queued_telemetry(), OnboardTime{1s}, TimePoint{1s});
  EXPECT_EQ(queue.push(queued_telemetry(long_packet), OnboardTime{2s}, TimePoint{2s}), 0U);
  queue.push(queued_telemetry(), OnboardTime{3s}, TimePoint{3s});  // costs the first its place
  EXPECT_EQ(queue.waiting(), 2U);
  const auto all = take_all(queue);
  ASSERT_THAT(numbers(all), ElementsAre(1, 3));
  EXPECT_EQ(all[0].lost, 2U);
  EXPECT_EQ(all[0].stored, OnboardTime{1s});
  EXPECT_EQ(all[0].monotonic, TimePoint{1s});
  EXPECT_EQ(all[0].note, Note{"no room before the database, up to number 2"});
  EXPECT_EQ(queue.refused(), 1U);
  EXPECT_EQ(queue.lost(), 1U);
}

TEST(LogQueue, UsesItsRingOfTelemetryToTheLastOctetAndThatOfTelecommandsToThreeQuarters) {
  LogQueue queue{{.telemetry_records = 8, .telemetry_octets = 10, .vital_records = 80, .vital_octets = 40}, {}};
  const std::vector<std::byte> packet(40);
  const auto telecommand = [&](std::size_t octets) {
    return push(queue, {.kind = LogKind::TelecommandForwarded, .packet = Octets{packet}.first(octets)});
  };
  for (int i = 0; i < 2; ++i) EXPECT_NE(push(queue, queued_telemetry(Octets{packet}.first(5))), 0U);
  EXPECT_EQ(queue.lost(), 0U);
  EXPECT_EQ(telecommand(31), 0U);
  EXPECT_NE(telecommand(30), 0U);
  EXPECT_EQ(telecommand(1), 0U);
  EXPECT_NE(telecommand(0), 0U);
  const LogEntry action{.kind = LogKind::Action, .packet = Octets{packet}.first(10)};
  EXPECT_NE(push(queue, action), 0U);
  EXPECT_EQ(push(queue, action), 0U);
}

TEST(LogQueue, ABatchIsFullWhenItHasAllItsRecordsOrAMillionOctets) {
  LogBatch few{2};
  EXPECT_TRUE(few.empty());
  static_cast<void>(few.add(0));
  EXPECT_FALSE(few.full());
  static_cast<void>(few.add(0));
  EXPECT_TRUE(few.full());
  LogBatch many{2};
  static_cast<void>(many.add(LogBatch::full_octets - 1));
  EXPECT_FALSE(many.full());
  many.clear();
  EXPECT_TRUE(many.empty());
  EXPECT_TRUE(many.add(1).packet.size() == 1 && !many.full()) << "octets are of this batch only";
  many.clear();
  static_cast<void>(many.add(LogBatch::full_octets));
  EXPECT_TRUE(many.full());
}

TEST(LogQueue, IsUrgentAsLongAsARecordIsInItThatMayNotWait) {
  LogQueue queue{{}, {}};
  LogBatch batch;
  LogEntry waiting = queued_telecommand();
  waiting.may_wait = true;
  push(queue, queued_telemetry());
  push(queue, waiting);
  EXPECT_FALSE(queue.urgent_waiting());
  push(queue, queued_telecommand());
  push(queue, waiting);
  EXPECT_TRUE(queue.urgent_waiting());
  queue.take(batch, 2);
  EXPECT_TRUE(queue.urgent_waiting()) << "it waits behind those that were taken";
  queue.take(batch, 1);
  EXPECT_FALSE(queue.urgent_waiting());
  push(queue, queued_telecommand());
  EXPECT_TRUE(queue.urgent_waiting());
}

TEST(LogQueue, ABatchKeepsNoMoreRoomThanABoundHoweverLongThePacketsOfEachPlaceOnceWere) {
  constexpr std::size_t places = 200, longest = 65'000;
  LogBatch batch{places};
  std::size_t most = 0;
  // Each place has a long packet in its turn, in batches that end early for their octets.
  for (std::size_t place = 0; place < places; ++place) {
    for (std::size_t i = 0; i < place; ++i) static_cast<void>(batch.add(1));
    static_cast<void>(batch.add(longest));
    batch.clear();
    most = std::max(most, batch.kept_octets());
  }
  EXPECT_GT(most, longest) << "it is kept";
  EXPECT_LE(most, LogBatch::most_kept_octets);
}

TEST(LogQueue, PushesOutTheOldestTelemetryAndSaysExactlyHowMuch) {
  LogQueue queue{{.telemetry_records = 2, .telemetry_octets = 100, .vital_records = 8, .vital_octets = 100}, {}};
  push(queue, queued_telecommand());
  for (int i = 0; i < 5; ++i) push(queue, queued_telemetry());  // 2..6
  push(queue, queued_telecommand());
  const auto all = take_all(queue);
  EXPECT_THAT(numbers(all), ElementsAre(1, 2, 5, 6, 7));
  EXPECT_EQ(all[1].kind, LogKind::Gap);
  EXPECT_EQ(all[1].lost, 3U);
  EXPECT_EQ(queue.lost(), 3U);
}

TEST(LogQueue, NeverPushesOutTelecommandsAndEventsOfSeverityMediumAndHigh) {
  LogQueue queue{{.telemetry_records = 4, .telemetry_octets = 100, .vital_records = 4, .vital_octets = 100}, {}};
  std::array<std::byte, 9> report{std::byte{0x08}, {}, {}, {}, {}, {}, {}, std::byte{5}, std::byte{3}};
  ASSERT_NE(push(queue, queued_telecommand()), 0U);
  ASSERT_NE(push(queue, {.kind = LogKind::Event, .packet = report}), 0U);
  for (int i = 0; i < 1000; ++i) ASSERT_NE(push(queue, queued_telemetry()), 0U);
  report[8] = std::byte{2};
  for (int i = 0; i < 1000; ++i) ASSERT_NE(push(queue, {.kind = LogKind::Event, .packet = report}), 0U);
  const auto all = take_all(queue);
  EXPECT_EQ(all[0].kind, LogKind::TelecommandReceived);
  EXPECT_EQ(all[1].packet[8], std::byte{3});
  EXPECT_EQ(all[2].lost, 1996U);
}

TEST(LogQueue, RefusesATelecommandWithoutRoomButStillTakesAnEvent) {
  LogQueue queue{{.telemetry_records = 4, .telemetry_octets = 100, .vital_records = 8, .vital_octets = 100}, {}};
  for (int i = 0; i < 6; ++i) EXPECT_NE(push(queue, queued_telecommand()), 0U);
  EXPECT_EQ(push(queue, queued_telecommand()), 0U);
  EXPECT_EQ(push(queue, {.kind = LogKind::Event, .packet = {}}), 8U);
  EXPECT_EQ(queue.refused(), 1U);
  const auto all = take_all(queue);
  EXPECT_THAT(numbers(all), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_EQ(all[6].kind, LogKind::Gap);
  EXPECT_EQ(all[6].lost, 1U);
}

TEST(LogQueue, RefusesAPacketThatCanNeverFit) {
  LogQueue queue{{.telemetry_records = 4, .telemetry_octets = 10, .vital_records = 8, .vital_octets = 10}, {}};
  const std::vector<std::byte> packet(11);
  push(queue, queued_telemetry());
  EXPECT_EQ(push(queue, queued_telemetry(packet)), 0U);
  EXPECT_EQ(queue.lost(), 0U);
}

TEST(LogQueue, RefusesAPacketLongerThanAnySpacePacketThoughThereIsRoom) {
  constexpr std::size_t room = 1'000'000;
  LogQueue queue{{.telemetry_records = 4, .telemetry_octets = room, .vital_records = 8, .vital_octets = room}, {}};
  const std::vector<std::byte> packet(Database::max_packet_octets + 1);
  EXPECT_EQ(push(queue, queued_telemetry(packet)), 0U);
  EXPECT_EQ(push(queue, {.kind = LogKind::TelecommandReceived, .packet = packet}), 0U);
  EXPECT_NE(push(queue, queued_telemetry(Octets{packet}.first(Database::max_packet_octets))), 0U);
  EXPECT_EQ(queue.refused(), 2U);
}

TEST(LogQueue, KeepsTheLastQuarterForEventsActionsAndTheNoteOfASwitch) {
  for (const LogKind kind : {LogKind::Event, LogKind::Action, LogKind::Switched, LogKind::TelecommandRefused}) {
    LogQueue queue{{.telemetry_records = 4, .telemetry_octets = 100, .vital_records = 8, .vital_octets = 100}, {}};
    for (int i = 0; i < 6; ++i) push(queue, queued_telecommand());
    const bool kept = kind != LogKind::TelecommandRefused;
    EXPECT_EQ(push(queue, {.kind = kind, .packet = {}}) != 0, kept) << static_cast<int>(kind);
    EXPECT_EQ(push(queue, queued_telecommand()), 0U) << "also once somebody uses it";
  }
}

/// A secondary header as far as the label needs it: version and flags, service, subtype.
TEST(LogQueue, MayLoseInformativeAndLowEventsOnly) {
  std::array<std::byte, 32> packet{};
  packet[0] = std::byte{0x08};
  packet[5] = std::byte{packet.size() - 7};
  const auto lost = [&](std::uint8_t service, std::uint8_t subtype) {
    packet[7] = std::byte{service};
    packet[8] = std::byte{subtype};
    return may_be_lost({.kind = LogKind::Event, .packet = packet});
  };
  EXPECT_TRUE(lost(5, 1));
  EXPECT_TRUE(lost(5, 2));
  EXPECT_FALSE(lost(5, 3));
  EXPECT_FALSE(lost(5, 4));
  EXPECT_FALSE(lost(1, 1));
  EXPECT_FALSE(may_be_lost({.kind = LogKind::TelecommandReceived, .packet = packet}));
  EXPECT_TRUE(may_be_lost({.kind = LogKind::Telemetry, .packet = packet}));
}

TEST(LogQueue, TakesUpToANumberOnly) {
  LogQueue queue{{}, {}};
  for (int i = 0; i < 5; ++i) push(queue, queued_telecommand());
  LogBatch batch{100};
  queue.take(batch, LogQueue::none, 3);
  EXPECT_EQ(batch.records().size(), 3U);
  EXPECT_EQ(queue.next_waiting(), 4U);
}

// Against a plain model: whatever is pushed and taken, every number comes out once or stands in a gap, octets unharmed.
TEST(LogQueue, LosesNothingUnsaidUnderRandomUse) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random{seed};
    LogQueue queue{{.telemetry_records = 7, .telemetry_octets = 61, .vital_records = 9, .vital_octets = 83}, {}};
    std::map<std::uint64_t, std::vector<std::byte>> pushed;
    std::vector<LogRecord> out;
    LogBatch batch{4};
    for (int step = 0; step < 2000; ++step) {
      if (random() % 4 == 0) {
        queue.take(batch, random() % 6);
        out.insert(out.end(), batch.records().begin(), batch.records().end());
        batch.clear();
        continue;
      }
      std::vector<std::byte> packet(random() % 25);
      for (std::byte& octet : packet) octet = static_cast<std::byte>(random());
      const LogEntry entry{.kind = random() % 2 == 0 ? LogKind::Telemetry : LogKind::TelecommandForwarded,
                           .packet = packet};
      if (const std::uint64_t number = push(queue, entry); number != 0) pushed[number] = packet;
    }
    const auto rest = take_all(queue);
    out.insert(out.end(), rest.begin(), rest.end());
    std::uint64_t lost = 0;
    std::uint64_t before = 0;
    for (const LogRecord& record : out) {
      ASSERT_GT(record.number, before) << "seed " << seed;
      before = record.number;
      lost += record.lost;
      if (record.kind != LogKind::Gap) {
        ASSERT_EQ(record.packet, pushed.at(record.number)) << "seed " << seed;
      }
    }
    std::size_t gaps = 0;
    for (const LogRecord& record : out) gaps += record.kind == LogKind::Gap ? 1 : 0;
    EXPECT_EQ(out.size() - gaps + lost, queue.last_number()) << "seed " << seed;
    EXPECT_EQ(lost, queue.lost() + queue.refused());
  }
}

TEST(LogQueue, GoesOnWithRunAndNumbersOfOneThatDiedAndSaysExactlyWhatIsMissing) {
  LogQueue queue{{}, OnboardTime{50s}};
  queue.resume({.run = OnboardTime{5s}, .last = 20, .durable = 17}, OnboardTime{51s}, TimePoint{1s});
  EXPECT_EQ(push(queue, queued_telemetry()), 21U);
  const auto all = take_all(queue);
  ASSERT_THAT(numbers(all), ElementsAre(18, 21));
  EXPECT_EQ(all[0].kind, LogKind::Gap);
  EXPECT_EQ(all[0].lost, 3U);
  EXPECT_EQ(all[0].run, OnboardTime{5s});
  EXPECT_EQ(all[1].run, OnboardTime{5s});
  EXPECT_THAT(std::string{all[0].note.view()}, ::testing::EndsWith("up to number 20"));
}

TEST(LogQueue, OfOneThatDiedWithEverythingOnTheDiskNothingIsMissing) {
  LogQueue queue{{}, OnboardTime{50s}};
  queue.resume({.run = OnboardTime{5s}, .last = 20, .durable = 20}, OnboardTime{51s}, TimePoint{1s});
  EXPECT_TRUE(queue.empty());
  queue.found_on_disk(20);
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.lost(), 0U);
  EXPECT_EQ(push(queue, queued_telecommand()), 21U);
}

TEST(LogQueue, WhatIsFoundOnTheDiskIsNotMissingWhateverHasComeMeanwhile) {
  for (std::uint64_t found = 16; found <= 25; ++found) {
    LogQueue queue{{.telemetry_records = 2, .telemetry_octets = 1000}, OnboardTime{50s}};
    queue.resume({.run = OnboardTime{5s}, .last = 20, .durable = 17}, OnboardTime{51s}, TimePoint{1s});
    EXPECT_EQ(push(queue, queued_telecommand()), 21U);
    for (std::uint64_t number = 22; number <= 24; ++number) EXPECT_EQ(push(queue, queued_telemetry()), number);
    EXPECT_EQ(queue.before_waiting(), 17U);
    queue.found_on_disk(found);
    const std::uint64_t durable = std::clamp<std::uint64_t>(found, 17, 20);
    EXPECT_EQ(queue.before_waiting(), durable) << found;
    EXPECT_EQ(queue.lost(), 20 - durable + 1) << "of its own the oldest telemetry";
    const auto all = take_all(queue);
    std::uint64_t next = durable + 1;
    for (const LogRecord& record : all) {
      EXPECT_EQ(record.number, next) << found;
      next += record.kind == LogKind::Gap ? record.lost : 1;
    }
    EXPECT_EQ(next, 25U) << found;
  }
}

TEST(LogQueue, WhereAllIsFoundOnTheDiskNothingWaits) {
  LogQueue queue{{}, OnboardTime{50s}};
  queue.resume({.run = OnboardTime{5s}, .last = 20, .durable = 17}, OnboardTime{51s}, TimePoint{1s});
  EXPECT_EQ(queue.waiting(), 1U);
  queue.found_on_disk(20);
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.waiting(), 0U);
  EXPECT_EQ(queue.before_waiting(), 20U);
}

}  // namespace
}  // namespace hirosco::supervisor
