// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <optional>
#include <thread>

#include "hirosco/utilities/os/clock.hpp"
#include "supervisor/platform/storage/begin_log.hpp"
#include "supervisor/platform/storage/packet_log.hpp"
#include "supervisor/platform/storage/testing/test_databases.hpp"

/// The log of one that died, gone on with over a disk that does not answer (docs/adr/0192).
namespace hirosco::supervisor {
namespace {

/// What a successor finds while the disk does not answer: its thread stands in there, and nobody else does.
struct ResumedOverAStalledDisk : ::testing::Test {
  const SystemClock clock;
  const OnboardTime run{7s};
  std::shared_ptr<MemoryDatabase> memory = std::make_shared<MemoryDatabase>();
  std::shared_ptr<Stall> stall = std::make_shared<Stall>();
  std::atomic<std::uint64_t> number{13};

  /// It has `reached`; noted are 13 numbers, of which 4 on the disk.
  [[nodiscard]] ThreadedPacketLog::Options options(std::uint64_t reached, Duration flush_limit = long_enough) {
    for (std::uint64_t each = 1; each <= reached; ++each) {
      LogRecord record;
      record.run = run;
      record.number = each;
      EXPECT_TRUE(memory->append({&record, 1}));
    }
    return {.flush_limit = flush_limit,
            .resume = LogResumption{.run = run, .last = 13, .durable = 4},
            .resolve =
                [stall = stall](Database& database, const LogResumption& noted) {
                  stall->reached.post();
                  stall->release.wait();
                  return resumption_in(database, noted);
                },
            .number = &number};
  }
};

TEST_F(ResumedOverAStalledDisk, NumbersAreGivenMeanwhileAndNoneTwiceNorTakenForLost) {
  for (const std::uint64_t reached : {4U, 10U, 13U}) {
    memory = std::make_shared<MemoryDatabase>();
    stall = std::make_shared<Stall>();
    ThreadedPacketLog log{clock, std::make_unique<Shared>(memory), options(reached)};
    stall->reached.wait();
    EXPECT_EQ(log.durable(), 4U) << "as the one before had told";
    EXPECT_EQ(log.append(telecommand()), 14U);
    EXPECT_FALSE(log.flush(1ms));
    EXPECT_EQ(all_of(*memory).size(), reached) << "nothing is stored before it is known where";
    stall->release.count_down();
    ASSERT_TRUE(log.flush(long_enough));
    EXPECT_EQ(log.durable(), 14U);
    EXPECT_EQ(log.counters().lost, 13 - reached);
    expect_complete(all_of(*memory), 14);
  }
}

TEST_F(ResumedOverAStalledDisk, WhoWaitsForTheDiskHearsThatAllIsThereThoughNothingIsToBeStored) {
  ThreadedPacketLog log{clock, std::make_unique<Shared>(memory), options(13)};
  stall->reached.wait();
  EXPECT_FALSE(log.flush(1ms));
  stall->release.count_down();
  EXPECT_TRUE(log.flush(long_enough));
  EXPECT_EQ(log.durable(), 13U);
  EXPECT_EQ(all_of(*memory).size(), 13U);
}

TEST_F(ResumedOverAStalledDisk, EndsWithoutWaitingForIt) {
  {
    ThreadedPacketLog log{clock, std::make_unique<Shared>(memory), options(10, 1ms)};
    EXPECT_EQ(log.append(telecommand()), 14U);
    stall->reached.wait();
  }
  EXPECT_EQ(all_of(*memory).size(), 10U);
  stall->release.count_down();
  while (memory.use_count() > 1) std::this_thread::yield();  // the writer ends by itself
  EXPECT_EQ(all_of(*memory).size(), 10U);
}

TEST_F(ResumedOverAStalledDisk, ADatabaseThatDoesNotSayYetIsAskedAgain) {
  auto of_log = options(10);
  auto asked = std::make_shared<std::atomic<int>>(0);
  of_log.resolve = [asked](Database& database, const LogResumption& noted) -> std::optional<LogResumption> {
    if (++*asked < 3) return std::nullopt;
    return resumption_in(database, noted);
  };
  ThreadedPacketLog log{clock, std::make_unique<Shared>(memory), std::move(of_log)};
  EXPECT_EQ(log.append(telecommand()), 14U);
  ASSERT_TRUE(log.flush(long_enough));
  EXPECT_EQ(*asked, 3);
  expect_complete(all_of(*memory), 14);
}

TEST_F(ResumedOverAStalledDisk, ADatabaseThatNeverSaysKeepsNobodyFromEndingAndWhatWasNotedHolds) {
  auto of_log = options(4);
  of_log.resolve = [](Database&, const LogResumption&) { return std::optional<LogResumption>{}; };
  {
    ThreadedPacketLog log{clock, std::make_unique<Shared>(memory), std::move(of_log)};
    EXPECT_EQ(log.append(telecommand()), 14U);
  }
  const auto records = all_of(*memory);
  expect_complete(records, 14);
  ASSERT_EQ(records.size(), 6U);
  EXPECT_EQ(records[4].kind, LogKind::Gap);
  EXPECT_EQ(records[4].number, 5U);
  EXPECT_EQ(records[4].lost, 9U);
  EXPECT_EQ(records[5].number, 14U);
}

TEST_F(ResumedOverAStalledDisk, ItsOwnerIsToldOfWhatIsOnTheDiskThoughNothingIsToBeStored) {
  Semaphore told;
  auto of_log = options(10);
  of_log.on_progress = [&told] { told.post(); };
  ThreadedPacketLog log{clock, std::make_unique<Shared>(memory), std::move(of_log)};
  stall->reached.wait();
  EXPECT_EQ(log.durable(), 4U);
  stall->release.count_down();
  told.wait();
  EXPECT_EQ(log.durable(), 10U);
}

TEST_F(ResumedOverAStalledDisk, ADatabaseThatNeverSaysIsLeftForAnother) {
  auto of_log = options(4);
  of_log.resolve = [](Database&, const LogResumption&) { return std::optional<LogResumption>{}; };
  ThreadedPacketLog log{clock, std::make_unique<BreakingDatabase>(0, memory), std::move(of_log)};
  auto next = std::make_shared<MemoryDatabase>();
  log.switch_to(std::make_unique<Shared>(next));
  EXPECT_EQ(log.append(telecommand()), 15U);
  while (log.failure() || log.durable() < 15) std::this_thread::yield();
  const auto records = all_of(*next);
  ASSERT_FALSE(records.empty());
  EXPECT_EQ(records.front().kind, LogKind::Gap) << "what was noted holds";
  EXPECT_EQ(records.front().number, 5U);
}

}  // namespace
}  // namespace hirosco::supervisor
