// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/packet_log.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/semaphore.hpp"
#include "supervisor/platform/storage/begin_log.hpp"
#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

TEST(ThreadedPacketLog, MakesWhatItTakesDurableInOrder) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  ThreadedPacketLog log{clock, std::make_unique<Shared>(memory), {}};
  for (int i = 0; i < 5000; ++i) ASSERT_NE(log.append(i % 10 == 0 ? telecommand() : telemetry()), 0U);
  ASSERT_TRUE(log.flush(long_enough));
  EXPECT_EQ(log.durable(), 5000U);
  const auto records = all_of(*memory);
  EXPECT_EQ(records.size(), 5000U);
  expect_complete(records, 5000);
  EXPECT_EQ(log.counters().accepted, 5000U);
  EXPECT_LT(log.counters().batches, 5000U) << "no group commit";
}

TEST(ThreadedPacketLog, AStalledDiskBlocksNobodyAndTelecommandsSurvive) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  auto stall = std::make_shared<Stall>();
  ThreadedPacketLog log{
      clock,
      std::make_unique<StalledDatabase>(stall, memory),
      {.limits = {.telemetry_records = 100, .telemetry_octets = 1000, .vital_records = 400, .vital_octets = 1000}}};
  ASSERT_EQ(log.append(telecommand()), 1U);
  stall->reached.wait();
  for (int i = 0; i < 200; ++i) {
    ASSERT_NE(log.append(telecommand()), 0U);
    for (int k = 0; k < 10; ++k) ASSERT_NE(log.append(telemetry()), 0U);
  }
  EXPECT_EQ(log.durable(), 0U);
  EXPECT_EQ(log.counters().lost, 1900U);
  stall->release.count_down();
  ASSERT_TRUE(log.flush(long_enough));
  const auto records = all_of(*memory);
  expect_complete(records, 2201);
  EXPECT_EQ(std::ranges::count(records, LogKind::TelecommandReceived, &LogRecord::kind), 201);
}

TEST(ThreadedPacketLog, GoesOnWithTheLogOfOneThatDied) {
  const TestFolder folder;
  const SystemClock clock;
  const auto path = folder.path() / "log.db";
  std::atomic<std::uint64_t> number{0};
  OnboardTime run{};
  {
    ThreadedPacketLog log{clock, std::move(*open_database(DatabaseStrategy::Sqlite, path)), {.number = &number}};
    for (int i = 0; i < 10; ++i) ASSERT_NE(log.append(telecommand()), 0U);
    ASSERT_TRUE(log.flush(long_enough));
    run = log.run();
  }
  EXPECT_EQ(number.load(), 10U);
  // It had noted less than what reached the disk, and given out more numbers.
  const auto from = resumption_of(path, {.run = run, .last = 13, .durable = 4});
  EXPECT_EQ(from.durable, 10U);
  ThreadedPacketLog next{clock, std::move(*open_database(DatabaseStrategy::Sqlite, path)), {.resume = from}};
  EXPECT_EQ(next.append(telecommand()), 14U);
  ASSERT_TRUE(next.flush(long_enough));
  const auto page = (*open_database(DatabaseStrategy::Sqlite, path, DatabaseAccess::Read))->read({.run = run});
  ASSERT_TRUE(page);
  expect_complete(page->records, 14);
}

TEST(ThreadedPacketLog, SwitchingUnderLoadLosesAndDoublesNothing) {
  const TestFolder folder;
  const SystemClock clock;
  constexpr std::uint64_t per_thread = 20'000;
  constexpr int switches = 6;
  const auto path_of = [&](int i) { return folder.path() / std::to_string(i); };
  const auto strategy_of = [](int i) { return i % 2 == 0 ? DatabaseStrategy::Sqlite : DatabaseStrategy::Ascii; };
  std::uint64_t last{};
  {
    ThreadedPacketLog log{clock, std::move(*open_database(strategy_of(0), path_of(0))), {}};
    std::vector<std::jthread> load;
    for (int t = 0; t < 2; ++t)
      load.emplace_back([&] {
        for (std::uint64_t i = 0; i < per_thread;)
          if (log.append(i % 8 == 0 ? telecommand() : telemetry()) != 0) ++i;
          else static_cast<void>(log.flush(long_enough));
      });
    for (int i = 1; i <= switches; ++i) {
      const std::uint64_t before = log.durable();
      log.switch_to(std::move(*open_database(strategy_of(i), path_of(i))));
      while (log.durable() == before && log.counters().accepted < 2 * per_thread) std::this_thread::yield();
    }
    load.clear();
    ASSERT_TRUE(log.flush(long_enough));
    last = log.durable();
  }
  std::vector<LogRecord> all;
  for (int i = 0; i <= switches; ++i) {
    const auto part = all_of(**open_database(strategy_of(i), path_of(i), DatabaseAccess::Read));
    all.insert(all.end(), part.begin(), part.end());
  }
  expect_complete(all, last);
  EXPECT_EQ(std::ranges::count(all, LogKind::TelecommandReceived, &LogRecord::kind), 2 * per_thread / 8);
}

TEST(ThreadedPacketLog, AFailedDatabaseIsReportedAndItsRecordsGoToTheNext) {
  const SystemClock clock;
  auto first = std::make_shared<MemoryDatabase>();
  auto second = std::make_shared<MemoryDatabase>();
  Semaphore progress;
  ThreadedPacketLog log{clock, std::make_unique<BreakingDatabase>(1, first), {.on_progress = [&] { progress.post(); }}};
  ASSERT_EQ(log.append(telecommand()), 1U);
  progress.wait();
  ASSERT_EQ(log.durable(), 1U);
  ASSERT_EQ(log.append(telecommand()), 2U);
  progress.wait();
  ASSERT_TRUE(log.failure());
  EXPECT_EQ(log.failure()->value, EIO);
  const auto flushed = log.flush(long_enough);
  ASSERT_FALSE(flushed);
  EXPECT_EQ(flushed.error().value, EIO) << "what it waits for in vain, and not that it waited";
  ASSERT_EQ(log.append(telemetry()), 3U);
  EXPECT_EQ(log.durable(), 1U);
  log.switch_to(std::make_unique<Shared>(second));
  ASSERT_NE(log.append(telecommand()), 0U);
  while (log.durable() < 4) progress.wait();
  EXPECT_FALSE(log.failure());
  EXPECT_EQ(all_of(*first).size(), 1U);
  const auto rest = all_of(*second);
  ASSERT_EQ(rest.size(), 3U);
  EXPECT_EQ(rest[0].number, 2U);
  EXPECT_EQ(log.counters().failures, 1U);
}

TEST(ThreadedPacketLog, EndsEvenWhenTheDiskNeverAnswers) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  auto stall = std::make_shared<Stall>();
  {
    ThreadedPacketLog log{clock, std::make_unique<StalledDatabase>(stall, memory), {.flush_limit = 1ms}};
    ASSERT_NE(log.append(telecommand()), 0U);
    stall->reached.wait();
  }
  EXPECT_EQ(all_of(*memory).size(), 0U);
  stall->release.count_down();
  while (all_of(*memory).empty()) std::this_thread::yield();   // the writer ends by itself
}

TEST(ThreadedPacketLog, TelemetryWaitsForCompanyAndIsWrittenWithoutATelecommand) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  Semaphore progress;
  ThreadedPacketLog log{
      clock, std::make_unique<Shared>(memory), {.delay = 1ms, .on_progress = [&] { progress.post(); }}};
  for (int i = 0; i < 5; ++i) ASSERT_NE(log.append(telemetry()), 0U);
  while (log.durable() < 5) progress.wait();
  expect_complete(all_of(*memory), 5);
  EXPECT_EQ(log.run(), all_of(*memory).front().run);
}

TEST(ThreadedPacketLog, ADatabaseThatSomebodyElseHoldsIsAskedAgainAndNothingIsLostOrToldAsDurable) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  auto hold = std::make_shared<HeldDatabase::Hold>();
  hold->tries = 1'000'000'000;
  ThreadedPacketLog log{clock, std::make_unique<HeldDatabase>(hold, memory), {}};
  ASSERT_EQ(log.append(telecommand()), 1U);
  for (int i = 0; i < 3; ++i) hold->tried.wait();
  EXPECT_EQ(log.durable(), 0U);
  hold->tries = 0;
  ASSERT_TRUE(log.flush(long_enough));
  EXPECT_EQ(log.durable(), 1U);
  EXPECT_FALSE(log.failure()) << "held is not failed";
  EXPECT_EQ(log.counters().failures, 0U);
}

TEST(ThreadedPacketLog, EndsWhileSomebodyElseHoldsItsDatabase) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  auto hold = std::make_shared<HeldDatabase::Hold>();
  hold->tries = 1'000'000'000;
  {
    ThreadedPacketLog log{clock, std::make_unique<HeldDatabase>(hold, memory), {.flush_limit = long_enough}};
    ASSERT_EQ(log.append(telecommand()), 1U);
    hold->tried.wait();
  }
  EXPECT_TRUE(all_of(*memory).empty());
}

TEST(ThreadedPacketLog, WhatAHeldDatabaseDidNotTakeGoesToTheNext) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  auto hold = std::make_shared<HeldDatabase::Hold>();
  hold->tries = 1'000'000'000;
  ThreadedPacketLog log{clock, std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>()), {}};
  ASSERT_EQ(log.append(telecommand()), 1U);
  hold->tried.wait();
  log.switch_to(std::make_unique<Shared>(memory));
  ASSERT_NE(log.append(telecommand()), 0U);
  ASSERT_TRUE(log.flush(long_enough));
  expect_complete(all_of(*memory), 3);
}

TEST(ThreadedPacketLog, TelemetryWaitsNoLongerOnceABatchIsFullOrSomebodyWaitsForIt) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  Semaphore progress;
  ThreadedPacketLog log{
      clock,
      std::make_unique<Shared>(memory),
      {.batch_records = 4, .delay = 3600s, .flush_limit = long_enough, .on_progress = [&] { progress.post(); }}};
  for (int i = 0; i < 4; ++i) ASSERT_NE(log.append(telemetry()), 0U);
  while (log.durable() < 4) progress.wait();
  ASSERT_NE(log.append(telemetry()), 0U);
  ASSERT_TRUE(log.flush(long_enough));
  expect_complete(all_of(*memory), 5);
}

TEST(ThreadedPacketLog, ATelecommandThatMayWaitHasCompanyUntilOneComesThatMayNot) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  ThreadedPacketLog log{clock, std::make_unique<Shared>(memory), {.delay = 3600s, .flush_limit = long_enough}};
  LogEntry waiting = telecommand();
  waiting.may_wait = true;
  for (int i = 0; i < 3; ++i) ASSERT_NE(log.append(waiting), 0U);
  ASSERT_NE(log.append(telecommand()), 0U);
  ASSERT_NE(log.append(waiting), 0U);
  ASSERT_TRUE(log.flush(long_enough));
  EXPECT_LE(log.counters().batches, 2U) << "those before it came with it";
  expect_complete(all_of(*memory), 5);
}

TEST(ThreadedPacketLog, EndsAtOnceWhenItsDatabaseHasFailed) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  {
    Semaphore progress;
    ThreadedPacketLog log{clock,
                          std::make_unique<BreakingDatabase>(0, memory),
                          {.flush_limit = 3600s, .on_progress = [&] { progress.post(); }}};
    ASSERT_EQ(log.append(telecommand()), 1U);
    while (!log.failure()) progress.wait();
  }
  EXPECT_TRUE(all_of(*memory).empty());
}

TEST(ThreadedPacketLog, AFlushThatComesToNoEndSaysSoAtItsLimit) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  auto stall = std::make_shared<Stall>();
  ThreadedPacketLog log{clock, std::make_unique<StalledDatabase>(stall, memory), {}};
  ASSERT_EQ(log.append(telecommand()), 1U);
  stall->reached.wait();
  const auto flushed = log.flush(1ms);
  ASSERT_FALSE(flushed);
  EXPECT_EQ(flushed.error().code, ErrorCode::Timeout);
  EXPECT_STREQ(flushed.error().text, "records are not durable yet");
  stall->release.count_down();
  EXPECT_TRUE(log.flush(long_enough));
}

TEST(ThreadedPacketLog, TroublesOfItsDatabasesAreToldAndCountedOverAllOfThem) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  auto hold = std::make_shared<HeldDatabase::Hold>();
  ThreadedPacketLog log{clock, std::make_unique<HeldDatabase>(hold, memory), {}};
  ASSERT_NE(log.append(telecommand()), 0U);
  ASSERT_TRUE(log.flush(long_enough));
  EXPECT_FALSE(log.failure());
  EXPECT_EQ(log.trouble().count, 0U);
  hold->troubles = 3;
  ASSERT_NE(log.append(telecommand()), 0U);
  while (log.trouble().count < 3) std::this_thread::yield();
  ASSERT_TRUE(log.failure()) << "as long as it is in trouble";
  EXPECT_EQ(log.failure()->value, ENOSPC);
  auto second = std::make_shared<HeldDatabase::Hold>();
  second->troubles = 2;
  log.switch_to(std::make_unique<HeldDatabase>(second, memory));
  ASSERT_NE(log.append(telecommand()), 0U);
  while (log.trouble().count < 5) std::this_thread::yield();
  EXPECT_EQ(log.trouble().count, 5U);
  EXPECT_EQ(log.counters().switches, 1U);
}

TEST(ThreadedPacketLog, WritesWhatWaitsBeforeItEnds) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  {
    ThreadedPacketLog log{clock, std::make_unique<Shared>(memory), {.delay = 3600s, .flush_limit = long_enough}};
    for (int i = 0; i < 10; ++i) ASSERT_NE(log.append(telemetry()), 0U);
  }
  expect_complete(all_of(*memory), 10);
}

TEST(ThreadedPacketLog, WritesTelemetryTogetherWithTheTelecommandThatItWaitedFor) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  Semaphore progress;
  ThreadedPacketLog log{
      clock, std::make_unique<Shared>(memory), {.delay = 3600s, .on_progress = [&] { progress.post(); }}};
  for (int i = 0; i < 200; ++i) ASSERT_NE(log.append(telemetry()), 0U);
  ASSERT_NE(log.append(telecommand()), 0U);
  while (log.durable() < 201) progress.wait();
  const LogCounters counters = log.counters();
  EXPECT_EQ(counters.accepted, 201U);
  EXPECT_EQ(counters.durable, 201U);
  EXPECT_EQ(counters.batches, 1U) << "though the queue is locked for some records at a time only";
  EXPECT_EQ(counters.high_water, 201U);
  EXPECT_EQ(counters.lost + counters.refused + counters.failures + counters.switches, 0U);
  expect_complete(all_of(*memory), 201);
}

TEST(ThreadedPacketLog, EndsAWorkingDatabaseWithANoteOfTheNextThatGoesOnBehindIt) {
  const SystemClock clock;
  auto first = std::make_shared<MemoryDatabase>();
  auto second = std::make_shared<MemoryDatabase>();
  ThreadedPacketLog log{clock, std::make_unique<Shared>(first), {}};
  ASSERT_EQ(log.append(telecommand()), 1U);
  ASSERT_TRUE(log.flush(long_enough)) << "so that nothing but the note waits";
  log.switch_to(std::make_unique<Shared>(second));
  ASSERT_EQ(log.append(telecommand()), 3U);
  ASSERT_TRUE(log.flush(long_enough));
  expect_complete(all_of(*first), 2);
  EXPECT_EQ(all_of(*first).back().kind, LogKind::Switched);
  EXPECT_EQ(all_of(*first).back().note, Note{"the log goes on in: shared"});
  ASSERT_EQ(all_of(*second).size(), 1U);
  EXPECT_EQ(all_of(*second).front().number, 3U);
  EXPECT_EQ(log.counters().switches, 1U);
}

TEST(ThreadedPacketLog, CountsWhatItRefusesBehindAStalledDisk) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  auto stall = std::make_shared<Stall>();
  ThreadedPacketLog log{
      clock,
      std::make_unique<StalledDatabase>(stall, memory),
      {.limits = {.telemetry_records = 2, .telemetry_octets = 10, .vital_records = 4, .vital_octets = 10}}};
  ASSERT_EQ(log.append(telecommand()), 1U);
  stall->reached.wait();
  for (int i = 0; i < 3; ++i) ASSERT_NE(log.append(telecommand()), 0U);
  EXPECT_EQ(log.append(telecommand()), 0U);
  for (int i = 0; i < 3; ++i) ASSERT_NE(log.append(telemetry()), 0U);
  const LogCounters counters = log.counters();
  EXPECT_EQ(counters.refused, 1U);
  EXPECT_EQ(counters.lost, 1U);
  EXPECT_EQ(counters.accepted, 6U);
  EXPECT_EQ(counters.high_water, 6U) << "three telecommands, two of telemetry, one gap";
  stall->release.count_down();
  ASSERT_TRUE(log.flush(long_enough));
  EXPECT_EQ(log.durable(), 8U);
  expect_complete(all_of(*memory), 8);
}

TEST(ThreadedPacketLog, TellsNobodyOfProgressOnceItIsGone) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  auto stall = std::make_shared<Stall>();
  auto told = std::make_shared<std::atomic<int>>(0);
  {
    ThreadedPacketLog log{clock,
                          std::make_unique<StalledDatabase>(stall, memory),
                          {.flush_limit = 1ms, .on_progress = [told] { ++*told; }}};
    ASSERT_NE(log.append(telecommand()), 0U);
    stall->reached.wait();
  }
  stall->release.count_down();
  while (told.use_count() > 1 || all_of(*memory).empty()) std::this_thread::yield();
  EXPECT_EQ(*told, 0);
}

/// Counts how often another thread than the test's asks it, which the writer does once in each of its steps.
struct CountingClock final : Clock {
  SystemClock real;
  std::thread::id owner{std::this_thread::get_id()};
  mutable std::atomic<int> asked{0};

 private:
  [[nodiscard]] TimePoint do_now() const noexcept override {
    if (std::this_thread::get_id() != owner) ++asked;
    return real.now();
  }
  [[nodiscard]] OnboardTime do_onboard() const noexcept override { return real.onboard(); }
};

TEST(ThreadedPacketLog, LetsTelemetryWaitForTheTelecommandThatComesAfterTheWriterSawIt) {
  const CountingClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  Semaphore progress;
  ThreadedPacketLog log{
      clock, std::make_unique<Shared>(memory), {.delay = 3600s, .on_progress = [&] { progress.post(); }}};
  constexpr std::uint64_t rounds = 5;
  for (std::uint64_t round = 1; round <= rounds; ++round) {
    const int before = clock.asked;
    ASSERT_NE(log.append(telemetry()), 0U);
    while (clock.asked == before) std::this_thread::yield();
    ASSERT_NE(log.append(telecommand()), 0U);
    while (log.durable() < 2 * round) progress.wait();
  }
  EXPECT_EQ(log.counters().batches, rounds);
}

TEST(ThreadedPacketLog, AsksItsClockNoLongerOnceItIsGone) {
  const CountingClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  auto stall = std::make_shared<Stall>();
  {
    ThreadedPacketLog log{clock, std::make_unique<StalledDatabase>(stall, memory), {.flush_limit = 1ms}};
    for (int i = 0; i < 3; ++i) ASSERT_NE(log.append(telecommand()), 0U);
    stall->reached.wait();
  }
  const int before = clock.asked;
  stall->release.count_down();
  while (stall.use_count() > 1) std::this_thread::yield();
  EXPECT_EQ(clock.asked, before);
}

TEST(ThreadedPacketLog, ATroubleOfTheDatabaseBeforeIsOverWithTheSwitch) {
  const SystemClock clock;
  auto hold = std::make_shared<HeldDatabase::Hold>();
  hold->troubles = 1;
  ThreadedPacketLog log{clock, std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>()), {}};
  ASSERT_NE(log.append(telecommand()), 0U);
  ASSERT_TRUE(log.flush(long_enough) || log.failure());
  while (!log.failure()) std::this_thread::yield();
  log.switch_to(std::make_unique<Shared>(std::make_shared<MemoryDatabase>()));
  while (log.failure()) std::this_thread::yield();
  EXPECT_FALSE(log.trouble().present);
  EXPECT_EQ(log.trouble().count, 1U) << "it is counted all the same";
}

/// Appends for ever and tells `pipe` what is durable. Ends by the signal of its parent only.
[[noreturn]] void log_until_killed(const std::filesystem::path& path, int pipe) {
  const SystemClock clock;
  ThreadedPacketLog log{clock, std::move(*open_database(DatabaseStrategy::Sqlite, path)), {}};
  std::uint64_t told = 0;
  const std::array<std::byte, 100> packet{};
  for (;;) {
    LogEntry entry = telemetry();
    entry.packet = packet;
    static_cast<void>(log.append(entry));
    static_cast<void>(log.append(telecommand()));
    const std::uint64_t durable = log.durable();
    if (durable != told && ::write(pipe, &durable, sizeof durable) != sizeof durable) ::_exit(1);
    told = durable;
  }
}

TEST(ThreadedPacketLog, EverythingReportedDurableIsInTheFileAfterKill) {
  for (const std::uint64_t enough : {1U, 50U, 3000U}) {
    const TestFolder folder;
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) log_until_killed(folder.path() / "log.db", pipe[1]);
    ::close(pipe[1]);
    std::uint64_t durable = 0;
    while (durable < enough && ::read(pipe[0], &durable, sizeof durable) == sizeof durable) {}
    ::kill(child, SIGKILL);
    std::uint64_t later{};
    while (::read(pipe[0], &later, sizeof later) == sizeof later) durable = later;
    ::close(pipe[0]);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    ASSERT_GE(durable, enough);

    auto records = all_of(**open_database(DatabaseStrategy::Sqlite, folder.path() / "log.db", DatabaseAccess::Read));
    ASSERT_FALSE(records.empty());
    std::uint64_t covered = 0;
    std::uint64_t before = 0;
    for (const LogRecord& record : records) {
      ASSERT_GT(record.number, before);
      before = record.number;
      if (record.number <= durable) covered += record.kind == LogKind::Gap ? record.lost : 1;
    }
    EXPECT_GE(before, durable);
    EXPECT_GE(covered, durable);
  }
}

}  // namespace
}  // namespace hirosco::supervisor
