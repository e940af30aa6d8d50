// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/semaphore.hpp"
#include "supervisor/platform/storage/packet_log.hpp"
#include "supervisor/platform/storage/testing/test_databases.hpp"

/// What the thread of a log does while nothing presses: it sleeps, and lets telemetry wait for as long as it may.
namespace hirosco::supervisor {
namespace {

/// Counts the steps of the writer, who asks the time once in each.
struct StepCountingClock final : Clock {
  SystemClock real;
  std::thread::id owner{std::this_thread::get_id()};
  mutable std::atomic<int> steps{0};

 private:
  [[nodiscard]] TimePoint do_now() const noexcept override {
    if (std::this_thread::get_id() != owner) ++steps;
    return real.now();
  }
  [[nodiscard]] OnboardTime do_onboard() const noexcept override { return real.onboard(); }
};

TEST(PatientPacketLog, WakesItsWriterForTheFirstRecordAndForAnUrgentOneOnly) {
  const StepCountingClock clock;
  Semaphore progress;
  ThreadedPacketLog log{clock,
                        std::make_unique<Shared>(std::make_shared<MemoryDatabase>()),
                        {.delay = 3600s, .on_progress = [&] { progress.post(); }}};
  constexpr int rounds = 20;
  constexpr int company = 200;
  std::uint64_t appended = 0;
  for (int round = 0; round < rounds; ++round) {
    for (int i = 0; i < company; ++i) appended = log.append(telemetry());
    appended = log.append(telecommand());
    while (log.durable() < appended) progress.wait();
  }
  // One for each wake, of which there are two a round, one behind each batch, and the first of all.
  EXPECT_EQ(log.counters().batches, static_cast<std::uint64_t>(rounds));
  EXPECT_LE(clock.steps, 1 + 3 * rounds) << "telemetry that finds company waiting wakes nobody, and nobody spins";
}

TEST(PatientPacketLog, LetsTelemetryWaitForCompanyAsLongAsItMay) {
  const SystemClock clock;
  constexpr Duration delay = 50ms;
  Semaphore progress;
  ThreadedPacketLog log{clock,
                        std::make_unique<Shared>(std::make_shared<MemoryDatabase>()),
                        {.delay = delay, .on_progress = [&] { progress.post(); }}};
  const TimePoint before = clock.now();
  ASSERT_EQ(log.append(telemetry()), 1U);
  while (log.durable() < 1) progress.wait();
  EXPECT_GE(clock.now() - before, delay) << "a disk that takes each record alone keeps up with fewer";
}

TEST(PatientPacketLog, CountsThePiecesOfAllItsDatabases) {
  const SystemClock clock;
  const auto database = [](const StoreTurnover& turnover) {
    auto hold = std::make_shared<HeldDatabase::Hold>();
    hold->turnover = turnover;
    return std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>());
  };
  const StoreTurnover first{
      .begun = 5, .removed_pieces = 4, .removed_octets = 300, .removed_records = 20, .newest_removed = "first"};
  const StoreTurnover second{
      .begun = 2, .removed_pieces = 1, .removed_octets = 100, .removed_records = 10, .newest_removed = "second"};
  const auto expect_sum = [](const StoreTurnover& all, std::string_view newest) {
    EXPECT_EQ(all.begun, 7U);
    EXPECT_EQ(all.removed_pieces, 5U);
    EXPECT_EQ(all.removed_octets, 400U);
    EXPECT_EQ(all.removed_records, 30U);
    EXPECT_EQ(all.newest_removed, newest);
  };
  ThreadedPacketLog log{clock, database(first), {}};
  ASSERT_NE(log.append(telecommand()), 0U);
  ASSERT_TRUE(log.flush(long_enough));
  EXPECT_EQ(log.counters().turnover.begun, 5U);
  log.switch_to(database(second));
  ASSERT_NE(log.append(telecommand()), 0U);
  ASSERT_TRUE(log.flush(long_enough));
  expect_sum(log.counters().turnover, "second");
  log.switch_to(database({}));
  ASSERT_NE(log.append(telecommand()), 0U);
  ASSERT_TRUE(log.flush(long_enough));
  expect_sum(log.counters().turnover, "second");

  DirectPacketLog direct{clock, database(first)};
  EXPECT_EQ(direct.counters().turnover.begun, 5U);
  direct.switch_to(database(second));
  expect_sum(direct.counters().turnover, "second");
  direct.switch_to(database({}));
  expect_sum(direct.counters().turnover, "second");
}

}  // namespace
}  // namespace hirosco::supervisor
