// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/packet_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <latch>
#include <thread>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/semaphore.hpp"
#include "supervisor/platform/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

using testing::ElementsAre;

/// Shares one database with the test after the log has closed it.
class Shared final : public Database {
 public:
  explicit Shared(std::shared_ptr<Database> real) : real_{std::move(real)} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override { return real_->append(batch); }
  Result<LogPage> do_read(const LogQuery& query) override { return real_->read(query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "shared"; }
  std::shared_ptr<Database> real_;
};

/// A disk that stands still until it is released.
struct Stall {
  Semaphore reached;
  std::latch release{1};
};
class StalledDatabase final : public Database {
 public:
  StalledDatabase(std::shared_ptr<Stall> stall, std::shared_ptr<Database> real)
      : stall_{std::move(stall)}, real_{std::move(real)} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override {
    stall_->reached.post();
    stall_->release.wait();
    return real_->append(batch);
  }
  Result<LogPage> do_read(const LogQuery& query) override { return real_->read(query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "stalled"; }
  std::shared_ptr<Stall> stall_;
  std::shared_ptr<Database> real_;
};

/// Stores `good` batches, then half a batch and an error.
class BreakingDatabase final : public Database {
 public:
  BreakingDatabase(int good, std::shared_ptr<Database> real) : good_{good}, real_{std::move(real)} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override {
    if (good_-- > 0) return real_->append(batch);
    return fail(ErrorCode::SystemFailure, "fdatasync", EIO);
  }
  Result<LogPage> do_read(const LogQuery& query) override { return real_->read(query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "breaking"; }
  int good_;
  std::shared_ptr<Database> real_;
};

/// Somebody else holds the database for the first so many tries; in trouble as long as the test says.
class HeldDatabase final : public Database {
 public:
  struct Hold {
    std::atomic<int> tries{0};
    std::atomic<std::uint64_t> troubles{0};
    Semaphore tried;
  };
  HeldDatabase(std::shared_ptr<Hold> hold, std::shared_ptr<Database> real)
      : hold_{std::move(hold)}, real_{std::move(real)} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override {
    hold_->tried.post();
    if (hold_->tries-- > 0) return fail(ErrorCode::Unavailable, "held");
    return real_->append(batch);
  }
  Result<LogPage> do_read(const LogQuery& query) override { return real_->read(query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "held"; }
  [[nodiscard]] StoreTrouble do_trouble() const override {
    StoreTrouble trouble;
    trouble.count = hold_->troubles;
    trouble.present = trouble.count != 0;
    trouble.error = {ErrorCode::SystemFailure, "held", ENOSPC};
    return trouble;
  }
  std::shared_ptr<Hold> hold_;
  std::shared_ptr<Database> real_;
};

std::vector<LogRecord> all_of(Database& database) { return database.read({.last = 10'000'000})->records; }

/// Records and gaps leave no number out and name none twice.
void expect_complete(const std::vector<LogRecord>& records, std::uint64_t last_number) {
  std::uint64_t covered = 0;
  std::uint64_t before = 0;
  for (const LogRecord& record : records) {
    EXPECT_GT(record.number, before);
    before = record.number;
    covered += record.kind == LogKind::Gap ? record.lost : 1;
  }
  EXPECT_EQ(covered, last_number);
}

LogEntry telemetry() { return {.kind = LogKind::Telemetry, .source = 11, .packet = {}}; }
LogEntry telecommand() { return {.kind = LogKind::TelecommandReceived, .peer = 11, .packet = {}}; }

constexpr Duration long_enough = 60s;   // never waited for unless the test fails

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
  EXPECT_FALSE(log.flush(long_enough));
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
  hold->tries = 2;
  ThreadedPacketLog log{clock, std::make_unique<HeldDatabase>(hold, memory), {}};
  ASSERT_EQ(log.append(telecommand()), 1U);
  hold->tried.wait();
  EXPECT_EQ(log.durable(), 0U);
  hold->tried.wait();
  hold->tried.wait();
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
