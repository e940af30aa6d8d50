// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/log_store.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>
#include <map>

#include "hirosco/utilities/os/clock.hpp"
#include "supervisor/platform/storage/begin_log.hpp"
#include "supervisor/platform/storage/packet_log.hpp"
#include "supervisor/platform/storage/testing/batches.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

namespace fs = std::filesystem;

class EveryLogStore : public ::testing::TestWithParam<DatabaseStrategy> {
 protected:
  [[nodiscard]] fs::path path() const { return folder_.path() / "log.sqlite"; }
  [[nodiscard]] fs::path piece(int number = 1) const { return piece_path(path(), GetParam(), number); }
  [[nodiscard]] LogPage page() const { return *read_log(path(), {.last = 1000}); }
  TestFolder folder_;
};

TEST_P(EveryLogStore, NoticesThatItsFileWasDeletedBeginsAnewAndCountsWhatWentWithIt) {
  LogStore store{GetParam(), path()};
  ASSERT_TRUE(store.append(batch_of(1, 5)));
  remove_piece(piece());
  ASSERT_TRUE(store.append(batch_of(6, 8)));
  EXPECT_EQ(store.trouble().count, 1U);
  EXPECT_EQ(store.trouble().fault, StoreFault::Deleted);
  EXPECT_FALSE(store.trouble().present) << "it goes on";
  const LogPage found = page();
  ASSERT_EQ(found.records.size(), 4U);
  EXPECT_EQ(found.records[0].kind, LogKind::Gap);
  EXPECT_EQ(found.records[0].number, 1U);
  EXPECT_EQ(covered(found), 8U);
}

TEST_P(EveryLogStore, NoticesThatAnotherFileWasPutInItsPlace) {
  LogStore store{GetParam(), path()};
  ASSERT_TRUE(store.append(batch_of(1, 5)));
  fs::rename(piece(), folder_.path() / "away");
  ASSERT_TRUE(store.append(batch_of(6, 6)));
  EXPECT_EQ(store.trouble().fault, StoreFault::Deleted);
  EXPECT_EQ(covered(page()), 6U);
}

TEST_P(EveryLogStore, StoresNothingWhileItsFolderIsGoneAndNotWritableAndResumesByItself) {
  const fs::path inner = folder_.path() / "inner";
  LogStore store{GetParam(), inner / "log.sqlite"};
  ASSERT_TRUE(store.append(batch_of(1, 2)));
  fs::remove_all(inner);
  std::ofstream{inner} << "a file where the folder was";
  for (int i = 0; i < 3; ++i) {
    const Result<> outcome = store.append(batch_of(3, 4));
    ASSERT_FALSE(outcome);
    EXPECT_EQ(outcome.error().code, ErrorCode::Unavailable);
    EXPECT_TRUE(store.trouble().present);
  }
  EXPECT_EQ(store.trouble().fault, StoreFault::Unwritable);
  EXPECT_EQ(store.trouble().count, 2U) << "deleted, and then not writable: each is said once";
  fs::remove(inner);
  ASSERT_TRUE(store.append(batch_of(3, 4)));
  EXPECT_FALSE(store.trouble().present);
  EXPECT_EQ(covered(*read_log(inner / "log.sqlite", {})), 4U);
}

INSTANTIATE_TEST_SUITE_P(Strategies, EveryLogStore,
                         ::testing::Values(DatabaseStrategy::Sqlite, DatabaseStrategy::Ascii),
                         [](const auto& strategy) { return std::string{to_text(strategy.param)}; });

/// A disk whose answers are written down: each append takes the next error, none = it works.
struct Disk {
  std::vector<std::optional<Error>> answers;
  std::map<fs::path, std::vector<LogRecord>> files;
  int opened{0};
};

class DiskDatabase final : public Database {
 public:
  DiskDatabase(Disk& disk, fs::path path) : disk_{disk}, path_{std::move(path)} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override {
    if (!disk_.answers.empty()) {
      const auto answer = disk_.answers.front();
      disk_.answers.erase(disk_.answers.begin());
      if (answer) return fail(*answer);
    }
    auto& file = disk_.files[path_];
    file.insert(file.end(), batch.begin(), batch.end());
    return ok();
  }
  Result<LogPage> do_read(const LogQuery&) override { return LogPage{}; }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "disk"; }
  Disk& disk_;
  fs::path path_;
};

LogStore store_on(Disk& disk, const fs::path& path) {
  return {DatabaseStrategy::Ascii, path, {}, [&disk](const fs::path& file) -> Result<std::unique_ptr<Database>> {
            ++disk.opened;
            std::ofstream{file, std::ios::app};
            return std::make_unique<DiskDatabase>(disk, file);
          }};
}

constexpr Error failed_fsync{ErrorCode::SystemFailure, "fdatasync of the log file", EIO};
constexpr Error no_space{ErrorCode::ResourceExhausted, "writing the log file", ENOSPC};

TEST(LogStore, LeavesASegmentAfterAFailedFsyncAndWritesWhatWasNotAcknowledgedToTheNext) {
  const TestFolder folder;
  Disk disk{.answers = {std::nullopt, failed_fsync}, .files = {}};
  LogStore store = store_on(disk, folder.path() / "log.log");
  ASSERT_TRUE(store.append(batch_of(1, 3)));
  EXPECT_EQ(store.append(batch_of(4, 6)).error().code, ErrorCode::Unavailable) << "not durable";
  EXPECT_EQ(store.trouble().fault, StoreFault::Damaged);
  EXPECT_TRUE(store.trouble().present);
  ASSERT_TRUE(store.append(batch_of(4, 6)));
  EXPECT_FALSE(store.trouble().present);
  EXPECT_EQ(disk.files[folder.path() / "log.log"].size(), 3U) << "the doubtful segment is not touched again";
  EXPECT_EQ(disk.files[folder.path() / "log.2.log"].size(), 3U);
}

/// One error at the start left the craft uncommissioned, with exit code 0.
TEST(BeginLog, GetsOverErrorsOfTheDiskAndSaysWhyWhereTheyLast) {
  const SystemClock clock;
  for (const std::size_t errors : {0U, 1U, 3U}) {
    const TestFolder folder;
    Disk disk{.answers = {errors, failed_fsync}, .files = {}};
    ThreadedPacketLog log{
        clock, std::unique_ptr<Database>{new LogStore{store_on(disk, folder.path() / "log.log")}}, {}};
    begin_log(log);
    EXPECT_EQ(why_not_begun(log, clock, 1min), std::nullopt) << errors;
  }
  const TestFolder folder;
  Disk disk{.answers = {100'000, failed_fsync}, .files = {}};
  ThreadedPacketLog log{clock, std::unique_ptr<Database>{new LogStore{store_on(disk, folder.path() / "log.log")}}, {}};
  begin_log(log);
  const auto why_not = why_not_begun(log, clock, 100ms);
  ASSERT_TRUE(why_not);
  EXPECT_NE(why_not->find("fdatasync of the log file, 5"), std::string::npos) << *why_not;
}

TEST(LogStore, LeavesNoTrailOfSegmentsOnADiskThatFailsForGood) {
  const TestFolder folder;
  Disk disk{.answers = {200, failed_fsync}, .files = {}};
  LogStore store = store_on(disk, folder.path() / "log.log");
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(store.append(batch_of(1, 1)));
  EXPECT_LE(std::distance(fs::directory_iterator{folder.path()}, fs::directory_iterator{}), 2);
  EXPECT_EQ(store.trouble().count, 1U) << "said once";
}

TEST(LogStore, StaysInItsSegmentWhenTheDiskIsFullAndResumesByItself) {
  const TestFolder folder;
  Disk disk{.answers = {std::nullopt, no_space, no_space, no_space}, .files = {}};
  LogStore store = store_on(disk, folder.path() / "log.log");
  ASSERT_TRUE(store.append(batch_of(1, 1)));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(store.append(batch_of(2, 2)).error().code, ErrorCode::Unavailable);
  EXPECT_EQ(store.trouble().fault, StoreFault::Full);
  EXPECT_EQ(store.trouble().count, 1U);
  EXPECT_NE(store.trouble().text.find("resumes by itself"), std::string::npos);
  ASSERT_TRUE(store.append(batch_of(2, 2)));
  EXPECT_FALSE(store.trouble().present);
  EXPECT_EQ(disk.files.size(), 1U);
}

TEST(LogStore, APacketLogHoldsBackDurableWhileItsStoreIsInTroubleAndRecordsTheGapExactly) {
  const SystemClock clock;
  const TestFolder folder;
  Disk disk{.answers = {50, no_space}, .files = {}};
  const fs::path path = folder.path() / "log.log";
  DirectPacketLog log{clock,
                      std::make_unique<LogStore>(store_on(disk, path)),
                      {.telemetry_records = 10, .telemetry_octets = 1000, .vital_records = 10, .vital_octets = 1000}};
  for (int i = 0; i < 49; ++i)
    static_cast<void>(log.append({.kind = LogKind::Telemetry, .packet = {}, .note = "housekeeping"}));
  EXPECT_EQ(log.durable(), 0U);
  ASSERT_TRUE(log.failure());
  EXPECT_EQ(log.trouble().fault, StoreFault::Full);
  static_cast<void>(log.append({.kind = LogKind::Telemetry, .packet = {}}));
  const std::uint64_t last = log.append({.kind = LogKind::Telemetry, .packet = {}});
  EXPECT_EQ(log.durable(), last);
  EXPECT_FALSE(log.failure());
  EXPECT_EQ(covered({.records = disk.files[path]}), last) << "records and gaps leave no number out";
}

TEST(LogStore, IsReadAsOneThingWhateverSegmentARecordStandsIn) {
  const TestFolder folder;
  const fs::path path = folder.path() / "log.log";
  ASSERT_TRUE((*open_database(DatabaseStrategy::Ascii, path))->append(batch_of(1, 4)));
  ASSERT_TRUE(
      (*open_database(DatabaseStrategy::Ascii, piece_path(path, DatabaseStrategy::Ascii, 2)))->append(batch_of(3, 6)));
  const auto page = read_log(path, {.last = 5});
  ASSERT_TRUE(page);
  ASSERT_EQ(page->records.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(page->records[i].number, i + 2);
}

}  // namespace
}  // namespace hirosco::supervisor
