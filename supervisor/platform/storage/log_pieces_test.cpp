// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/log_pieces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <random>

#include "hirosco/utilities/testing/slice.hpp"
#include "supervisor/platform/storage/ascii_database.hpp"
#include "supervisor/platform/storage/log_store.hpp"
#include "supervisor/platform/storage/testing/batches.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

class LogPieces : public ::testing::TestWithParam<DatabaseStrategy> {
 protected:
  [[nodiscard]] fs::path log() const { return folder_.path() / "log.db"; }
  [[nodiscard]] LogPage page(std::size_t last = 100'000) const { return *read_log(log(), {.last = last}); }
  [[nodiscard]] std::vector<int> numbers() const {
    std::vector<int> all;
    for (const LogPiece& piece : pieces_of(log())) all.push_back(piece.number);
    return all;
  }
  [[nodiscard]] std::uint64_t octets() const {
    std::uint64_t all = 0;
    for (const LogPiece& piece : pieces_of(log())) all += piece_octets(piece.path);
    return all;
  }
  void expect_each_once(std::uint64_t first, std::uint64_t last) const {
    const LogPage all = page();
    EXPECT_EQ(all.damaged, 0U);
    ASSERT_EQ(all.records.size(), last - first + 1);
    for (const LogRecord& record : all.records) ASSERT_EQ(record.number, first++);
  }
  TestFolder folder_;
};

constexpr std::uint64_t kilo = 1024;
constexpr LogLimits by_size{.rotate_octets = 200 * kilo};

/// So many batches of 10 records with 2 KiB each, from record 1 on.
void fill(LogStore& store, int batches, std::uint64_t first = 1) {
  for (int i = 0; i < batches; ++i, first += 10) ASSERT_TRUE(store.append(batch_of(first, first + 9, 2 * kilo)));
}

TEST_P(LogPieces, BeginTheNextOneWhenTheyAreLargeEnoughAndReadAsOneLog) {
  LogStore store{GetParam(), log(), by_size};
  fill(store, 50);
  EXPECT_GE(numbers().size(), 4U);
  EXPECT_EQ(store.turnover().begun + 1, numbers().size());
  EXPECT_EQ(store.trouble().count, 0U);
  expect_each_once(1, 500);
  const LogPage end = page(15);
  ASSERT_EQ(end.records.size(), 15U) << "also where the newest piece has fewer";
  EXPECT_EQ(end.records.front().number, 486U);
}

TEST_P(LogPieces, BeginTheNextOneWhenTheyAreOldEnoughAlsoOverARestart) {
  const LogLimits by_age{.rotate_age = 100s};
  {
    LogStore store{GetParam(), log(), by_age};
    for (const std::uint64_t at : {1U, 50U, 100U}) ASSERT_TRUE(store.append(batch_of(at, at)));
    EXPECT_THAT(numbers(), ElementsAre(1));
    ASSERT_TRUE(store.append(batch_of(101, 101)));
    EXPECT_THAT(numbers(), ElementsAre(1, 2));
  }
  LogStore again{GetParam(), log(), by_age};
  ASSERT_TRUE(again.append(batch_of(150, 150)));
  EXPECT_THAT(numbers(), ElementsAre(1, 2)) << "it goes on in the newest";
  ASSERT_TRUE(again.append(batch_of(201, 201)));
  EXPECT_THAT(numbers(), ElementsAre(1, 2, 3)) << "which is as old as its first record, whoever wrote that";
}

TEST_P(LogPieces, AreNeverMoreThanDeclaredAndWhatWasRemovedIsCounted) {
  const LogLimits bounded{.rotate_octets = 200 * kilo, .keep_octets = 600 * kilo};
  LogStore store{GetParam(), log(), bounded};
  const std::uint64_t one_batch = 10 * 2 * 2 * kilo + 16 * kilo;
  for (std::uint64_t first = 1; first < 1000; first += 10) {
    ASSERT_TRUE(store.append(batch_of(first, first + 9, 2 * kilo)));
    ASSERT_LE(octets(), bounded.keep_octets + one_batch);
  }
  const StoreTurnover done = store.turnover();
  EXPECT_GT(done.removed_pieces, 2U);
  EXPECT_GT(done.removed_records, 200U);
  expect_each_once(done.removed_records + 1, 1000);
}

TEST_P(LogPieces, OfAnotherStrategyAreNotGoneOnIn) {
  const DatabaseStrategy other =
      GetParam() == DatabaseStrategy::Sqlite ? DatabaseStrategy::Ascii : DatabaseStrategy::Sqlite;
  ASSERT_TRUE((LogStore{GetParam(), log()}.append(batch_of(1, 4))));
  ASSERT_TRUE((LogStore{other, log()}.append(batch_of(5, 6))));
  ASSERT_TRUE((LogStore{GetParam(), log()}.append(batch_of(7, 9))));
  ASSERT_TRUE((LogStore{GetParam(), log()}.append(batch_of(10, 10))));
  EXPECT_THAT(numbers(), ElementsAre(1, 2, 3));
  expect_each_once(1, 10);
}

TEST_P(LogPieces, ThatWereOnlyBegunAreNoDamage) {
  ASSERT_TRUE((LogStore{GetParam(), log()}.append(batch_of(1, 4))));
  std::ofstream{piece_path(log(), GetParam(), 2)};  // what a kill between opening and the first record leaves
  expect_each_once(1, 4);
  ASSERT_TRUE((LogStore{GetParam(), log()}.append(batch_of(5, 6))));
  EXPECT_THAT(numbers(), ElementsAre(1, 2));
  expect_each_once(1, 6);
}

TEST_P(LogPieces, OneDeletedAfterOthersIsTheGapThatItLeaves) {
  LogStore store{GetParam(), log(), by_size};
  fill(store, 30);
  const auto pieces = pieces_of(log());
  ASSERT_GE(pieces.size(), 2U);
  remove_piece(pieces.back().path);
  const std::uint64_t kept = page().records.back().number;
  ASSERT_TRUE(store.append(batch_of(301, 302)));
  EXPECT_EQ(store.trouble().lost, 300 - kept);
  const LogPage all = page();
  EXPECT_EQ(covered(all), 302U);
  EXPECT_EQ(all.records[kept].kind, LogKind::Gap);
  EXPECT_EQ(all.records[kept].number, kept + 1);
  EXPECT_EQ(all.records[kept].lost, 300 - kept);
}

/// An unmount shows what is beneath, a mount what was there before.
TEST_P(LogPieces, ThatGoAndComeBackWithTheirFolderAreNoGapAnyMore) {
  const fs::path folder = folder_.path() / "disk";
  const fs::path log = folder / "log.db";
  LogStore store{GetParam(), log};
  ASSERT_TRUE(store.append(batch_of(1, 100)));
  fs::rename(folder, folder_.path() / "unmounted");
  ASSERT_TRUE(store.append(batch_of(101, 150)));
  EXPECT_EQ(store.trouble().lost, 100U);
  EXPECT_EQ(covered(*read_log(log, {})), 150U);
  fs::rename(folder, folder_.path() / "beneath");
  fs::rename(folder_.path() / "unmounted", folder);
  ASSERT_TRUE(store.append(batch_of(151, 160)));
  EXPECT_EQ(store.trouble().lost, 50U);
  EXPECT_EQ(store.trouble().count, 2U);
  const LogPage all = *read_log(log, {});
  EXPECT_EQ(covered(all), 160U);
  EXPECT_EQ(all.records.size(), 111U);
}

TEST_P(LogPieces, ThatSomebodyEmptiesAreNoticedAndCounted) {
  LogStore store{GetParam(), log()};
  ASSERT_TRUE(store.append(batch_of(1, 100)));
  fs::resize_file(piece_path(log(), GetParam(), 1), 0);
  if (GetParam() == DatabaseStrategy::Sqlite) fs::resize_file(piece_path(log(), GetParam(), 1) += "-wal", 0);
  ASSERT_TRUE(store.append(batch_of(101, 110)));
  EXPECT_EQ(store.trouble().count, 1U);
  EXPECT_EQ(store.trouble().lost, 100U);
  EXPECT_EQ(covered(page()), 110U);
}

TEST(AsciiPieces, ThatSomebodyCutsKeepTheirBeginningAndTheGapIsWhatWentWithTheEnd) {
  const TestFolder folder;
  const fs::path log = folder.path() / "log.db";
  LogStore store{DatabaseStrategy::Ascii, log};
  ASSERT_TRUE(store.append(batch_of(1, 100)));
  const fs::path first = piece_path(log, DatabaseStrategy::Ascii, 1);
  fs::resize_file(first, fs::file_size(first) / 2);
  ASSERT_TRUE(store.append(batch_of(101, 110)));
  const LogPage all = *read_log(log, {});
  EXPECT_EQ(covered(all), 110U);
  EXPECT_GT(store.trouble().lost, 40U);
  EXPECT_LT(store.trouble().lost, 60U);
  EXPECT_EQ(all.damaged, 1U) << "the line that was cut";
}

TEST(AsciiPieces, OfAnotherVersionAreLeftAloneAndCountedAtReading) {
  const TestFolder folder;
  const fs::path log = folder.path() / "log.db";
  const fs::path first = piece_path(log, DatabaseStrategy::Ascii, 1);
  std::ofstream{first} << ascii_version_line(2) << '\n';
  const auto refused = read_log(log, {});
  ASSERT_FALSE(refused) << "it is all that there is";
  EXPECT_STREQ(refused.error().text, "log file of another version");
  const fs::path next = piece_path(log, DatabaseStrategy::Ascii, 2);
  fs::copy_file(first, next);
  EXPECT_FALSE(read_log(log, {})) << "nor is there more where there are two";
  fs::remove(next);
  const auto octets = fs::file_size(first);
  LogStore store{DatabaseStrategy::Ascii, log};
  EXPECT_FALSE(store.append(batch_of(1, 3)));
  EXPECT_EQ(
      store.trouble().text,
      "log log.log is left alone (log file of another version, 2): goes on in log.2.log; read the first with what "
      "wrote it");
  ASSERT_TRUE(store.append(batch_of(1, 3)));
  EXPECT_EQ(fs::file_size(first), octets);
  const LogPage all = *read_log(log, {});
  EXPECT_EQ(all.records.size(), 3U);
  EXPECT_EQ(all.damaged, 1U) << "the piece that cannot be read";
}

TEST_P(LogPieces, ThatGoWhileTheDiskIsFullAreAGap) {
  LogStore store{GetParam(), log(), {}, [&](const fs::path& file) -> Result<std::unique_ptr<Database>> {
                   if (fs::exists(folder_.path() / "full")) return fail(ErrorCode::ResourceExhausted, "full", ENOSPC);
                   return open_database(GetParam(), file);
                 }};
  ASSERT_TRUE(store.append(batch_of(1, 5)));
  std::ofstream{folder_.path() / "full"};
  remove_piece(piece_path(log(), GetParam(), 1));
  EXPECT_FALSE(store.append(batch_of(6, 7)));
  EXPECT_FALSE(store.append(batch_of(6, 7)));
  EXPECT_EQ(store.trouble().fault, StoreFault::Full);
  fs::remove(folder_.path() / "full");
  ASSERT_TRUE(store.append(batch_of(6, 7)));
  EXPECT_EQ(covered(page()), 7U);
  EXPECT_EQ(page().records.front().lost, 5U);
}

INSTANTIATE_TEST_SUITE_P(Strategies, LogPieces, ::testing::Values(DatabaseStrategy::Sqlite, DatabaseStrategy::Ascii),
                         [](const auto& strategy) { return std::string{to_text(strategy.param)}; });

TEST(PieceNames, AreThoseOfTheLogWhicheverOfThemIsGiven) {
  EXPECT_EQ(piece_path("log/a.db", DatabaseStrategy::Sqlite, 1), "log/a.db");
  EXPECT_EQ(piece_path("log/a.db", DatabaseStrategy::Sqlite, 12), "log/a.12.db");
  EXPECT_EQ(piece_path("log/a.db", DatabaseStrategy::Ascii, 2), "log/a.2.log");
  EXPECT_EQ(piece_path("log/a.log", DatabaseStrategy::Ascii, 1), "log/a.log");
  EXPECT_EQ(piece_path("log/a.log", DatabaseStrategy::Sqlite, 3), "log/a.3.db");
  EXPECT_EQ(piece_path("a.sqlite", DatabaseStrategy::Sqlite, 3), "a.3.sqlite");
  const TestFolder folder;
  for (const char* name : {"a.db", "a.2.log", "a.10.db", "a.9.db", "a-ground.db", "a.x.db", "a.0.db", "a.07.db",
                           "a.1.db", "a.2.db-wal", "a.epoch", "aa.db", "a..db", "a.99999999999.db"})
    std::ofstream{folder.path() / name};
  std::vector<std::string> found;
  for (const LogPiece& piece : pieces_of(folder.path() / "a.db")) found.push_back(piece.path.filename().string());
  EXPECT_THAT(found, ElementsAre("a.db", "a.2.log", "a.9.db", "a.10.db"));
}

/// Writes from `first` on until it is killed, rotating all the time and changing the strategy now and then; tells each number
/// that is durable.
[[noreturn]] void write_until_killed(const fs::path& log, std::uint64_t first, int told) {
  const LogLimits small{.rotate_octets = 40 * kilo};
  for (int i = 0;; ++i) {
    LogStore store{i % 2 == 0 ? DatabaseStrategy::Sqlite : DatabaseStrategy::Ascii, log, small};
    for (int batch = 0; batch < 20; ++batch, first += 5) {
      if (!store.append(batch_of(first, first + 4, kilo))) ::_exit(1);
      const std::uint64_t last = first + 4;
      if (::write(told, &last, sizeof last) != sizeof last) ::_exit(2);
    }
  }
}

TEST(KilledInRotation, NothingThatWasDurableIsLostAndNothingIsThereTwice) {
  const TestFolder folder;
  const fs::path log = folder.path() / "log.db";
  std::minstd_rand random{20};
  std::uint64_t durable = 0;
  const int kills = 25 / hirosco::testing::one_in(5);
  for (int kill = 0; kill < kills; ++kill) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const pid_t child = ::fork();
    if (child == 0) write_until_killed(log, durable + 1, ends[1]);
    ::close(ends[1]);
    const std::uint64_t wanted = durable + 5 * (1 + random() % 40);
    std::uint64_t told = 0;
    while (told < wanted && ::read(ends[0], &told, sizeof told) == sizeof told) {}
    ::kill(child, SIGKILL);
    while (::read(ends[0], &told, sizeof told) == sizeof told) {}
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "it ended by itself: " << status;
    const auto page = read_log(log, {.last = 1'000'000});
    ASSERT_TRUE(page);
    // A batch that was not told may stand there, whole or, of ASCII, in part.
    ASSERT_GE(page->records.size(), told);
    ASSERT_LE(page->records.size(), told + 5);
    for (std::uint64_t i = 0; i < page->records.size(); ++i) ASSERT_EQ(page->records[i].number, i + 1);
    ASSERT_LE(page->damaged, static_cast<std::uint64_t>(kill) + 1) << "at most the line that each kill has cut";
    durable = page->records.size();
  }
  EXPECT_GT(pieces_of(log).size(), static_cast<std::size_t>(kills));
  std::uint64_t stored = 0;
  for (const LogPiece& piece : pieces_of(log))
    stored +=
        (*open_database(piece.strategy, piece.path, DatabaseAccess::Read))->read({.last = 1'000'000})->records.size();
  EXPECT_EQ(stored, durable) << "each stands in one piece";
}

}  // namespace
}  // namespace hirosco::supervisor
