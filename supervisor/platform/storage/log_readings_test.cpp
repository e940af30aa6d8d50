// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/log_readings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <latch>
#include <thread>

#include "supervisor/platform/storage/log_pieces.hpp"
#include "supervisor/platform/storage/testing/batches.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;

std::vector<std::uint64_t> numbers_of(const Result<LogPage>& page) {
  std::vector<std::uint64_t> numbers;
  if (page)
    for (const LogRecord& record : page->records) numbers.push_back(record.number);
  return numbers;
}

Result<LogPage> wait_for(LogReadings& readings) {
  for (;;) {
    if (auto page = readings.outcome()) return std::move(*page);
    std::this_thread::yield();
  }
}

/// Two strategies, two pieces, one log: records 1 to 5 and 6 to 10.
struct LogReadingsTest : ::testing::Test {
  void SetUp() override {
    ASSERT_TRUE((*open_database(DatabaseStrategy::Sqlite, piece_path(log, DatabaseStrategy::Sqlite, 1)))
                    ->append(batch_of(1, 5)));
    ASSERT_TRUE((*open_database(DatabaseStrategy::Ascii, piece_path(log, DatabaseStrategy::Ascii, 2)))
                    ->append(batch_of(6, 10)));
  }
  TestFolder folder;
  std::filesystem::path log{folder.path() / "log.db"};
};

TEST_F(LogReadingsTest, TheOldestOfAllPiecesComeFirstAndTheNextPageGoesOn) {
  const LogReader read = reader_of(log, {});
  EXPECT_THAT(numbers_of(read({.last = 4, .end = LogEnd::Oldest})), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(numbers_of(read({.since = 5, .last = 4, .end = LogEnd::Oldest})), ElementsAre(5, 6, 7, 8));
  EXPECT_THAT(numbers_of(read({.since = 9, .last = 4, .end = LogEnd::Oldest})), ElementsAre(9, 10));
  EXPECT_THAT(numbers_of(read({.last = 4, .end = LogEnd::Newest})), ElementsAre(7, 8, 9, 10)) << "as before";
}

TEST_F(LogReadingsTest, ARangeOfTimesHasBothItsEnds) {
  const LogReader read = reader_of(log, {});
  const auto all = read({.end = LogEnd::Oldest});
  ASSERT_EQ(numbers_of(all).size(), 10U);
  const auto& records = all->records;
  EXPECT_THAT(numbers_of(read({.run = records[0].run,
                               .stored_from = records[3].stored,
                               .stored_to = records[6].stored,
                               .end = LogEnd::Oldest})),
              ElementsAre(4, 5, 6, 7));
}

TEST_F(LogReadingsTest, WhatIsNotThereIsSaid) {
  const auto page = reader_of(folder.path() / "other.db", {})({});
  ASSERT_FALSE(page);
  EXPECT_EQ(page.error().code, ErrorCode::NotFound);
}

TEST(ThreadedLogReadings, HoldNobodyUpAndReadOnePageAtATime) {
  auto disk = std::make_shared<std::latch>(1);
  ThreadedLogReadings readings{[disk](const LogQuery& query) -> Result<LogPage> {
    disk->wait();
    LogPage page;
    page.damaged = query.since;
    return page;
  }};
  ASSERT_TRUE(readings.begin({.since = 7}));
  EXPECT_FALSE(readings.outcome()) << "the disk stands still";
  EXPECT_EQ(readings.begin({}).error().code, ErrorCode::Unavailable);
  disk->count_down();
  EXPECT_EQ(wait_for(readings)->damaged, 7U);
  EXPECT_FALSE(readings.outcome()) << "once for each";
  EXPECT_TRUE(readings.begin({}));
  static_cast<void>(wait_for(readings));
}

TEST(ThreadedLogReadings, WhatFindsNoMemoryEndsTheReadingAndNothingElse) {
  ThreadedLogReadings readings{[](const LogQuery&) -> Result<LogPage> { throw std::bad_alloc{}; }};
  ASSERT_TRUE(readings.begin({}));
  EXPECT_EQ(wait_for(readings).error().code, ErrorCode::ResourceExhausted);
}

}  // namespace
}  // namespace hirosco::supervisor
