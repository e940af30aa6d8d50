// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/database.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>

#include "supervisor/platform/storage/log_pieces.hpp"
#include "supervisor/platform/storage/postgresql_database.hpp"
#include "supervisor/platform/storage/sqlite_database.hpp"
#include "supervisor/platform/storage/testing/postgresql_server.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// TC[17,1] to 0x73, a whole packet.
std::vector<std::byte> ping() {
  std::vector<std::byte> packet;
  for (int octet : {0x18, 0x73, 0xC0, 0x19, 0x00, 0x06, 0x2F, 0x11, 0x01, 0x00, 0x00, 0x73, 0xAB})
    packet.push_back(static_cast<std::byte>(octet));
  return packet;
}

LogRecord record(std::uint64_t number, LogKind kind = LogKind::Telemetry) {
  return {.run = OnboardTime{2'145'916'837s},
          .number = number,
          .stored = OnboardTime{2'145'916'837s + Duration{number}},
          .monotonic = TimePoint{Duration{number * 7}},
          .kind = kind,
          .source = 11,
          .peer = 0,
          .note = "x",
          .packet = ping()};
}

std::vector<std::uint64_t> numbers(const LogPage& page) {
  std::vector<std::uint64_t> all;
  for (const LogRecord& one : page.records) all.push_back(one.number);
  return all;
}

/// What every strategy must do alike.
class Databases : public ::testing::TestWithParam<DatabaseStrategy> {
 protected:
  void SetUp() override {
    if (GetParam() != DatabaseStrategy::Postgresql) return;
    // Where there is none, `testing/with_server` does not come here.
    const auto opened = open_postgresql({});
    ASSERT_TRUE(opened) << opened.error().text;
    ASSERT_TRUE(PostgresqlServer::installed());
    std::string why_not;
    server_ = PostgresqlServer::shared(why_not);
    ASSERT_NE(server_, nullptr) << why_not;
  }
  Result<std::unique_ptr<Database>> try_to_open(DatabaseAccess access) {
    if (server_ == nullptr) return open_database(GetParam(), path(), access);
    return open_postgresql({.connection = server_->connection(), .log = log_name(path())}, access);
  }
  std::unique_ptr<Database> open(DatabaseAccess access = DatabaseAccess::Write) {
    auto database = try_to_open(access);
    EXPECT_TRUE(database) << (database ? "" : database.error().text);
    return std::move(*database);
  }
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "log"; }

 private:
  TestFolder folder_;
  PostgresqlServer* server_{nullptr};
};

/// What every strategy must do that outlives its process.
class DatabasesOnDisk : public Databases {};

TEST_P(Databases, GiveOneKindAlone) {
  auto database = open();
  std::vector<LogRecord> batch{record(1, LogKind::TelecommandReceived), record(2, LogKind::Gap),
                               record(3, LogKind::Telemetry), record(4, LogKind::Gap)};
  for (LogRecord& each : batch) each.lost = each.kind == LogKind::Gap ? 1 : 0;
  ASSERT_TRUE(database->append(batch));
  const auto page = database->read({.kind = LogKind::Gap});
  ASSERT_TRUE(page);
  EXPECT_TRUE(page->records == (std::vector{batch[1], batch[3]}));
}

TEST(Gap, ReachesAsFarAsItsNoteSaysElseAsManyAsItHasLost) {
  LogRecord gap{.number = 11, .kind = LogKind::Gap, .lost = 100};
  EXPECT_EQ(last_lost(gap), 110U);
  gap.note = "no room before the database, up to number 300";
  EXPECT_EQ(last_lost(gap), 300U);
  gap.note = "up to number 7, which is before it";
  EXPECT_EQ(last_lost(gap), 110U);
}

TEST_P(Databases, GiveBackExactlyWhatWasStored) {
  auto database = open();
  std::vector<LogRecord> batch{record(1, LogKind::TelecommandReceived), record(2, LogKind::Gap)};
  batch[0].note = " from \"client 3\" #12: a,b\\ ";
  batch[0].packet.assign(Database::max_packet_octets, std::byte{0xA5});
  batch[1].lost = 4'000'000'000U;
  batch[1].packet.clear();
  batch[1].note = "";
  ASSERT_TRUE(database->append(batch));
  const auto page = database->read({});
  ASSERT_TRUE(page);
  EXPECT_TRUE(page->records == batch);
  EXPECT_EQ(page->damaged, 0U);
}

TEST_P(Databases, AnswerTheOldestRecordsWhereTheseAreAskedFor) {
  auto database = open();
  ASSERT_TRUE(database->append(std::vector{record(1), record(2), record(3), record(4)}));
  EXPECT_THAT(numbers(*database->read({.last = 2, .end = LogEnd::Oldest})), ElementsAre(1, 2));
  EXPECT_THAT(numbers(*database->read({.since = 3, .last = 5, .end = LogEnd::Oldest})), ElementsAre(3, 4));
}

TEST_P(DatabasesOnDisk, KeepRecordsBeyondTheirOwnLife) {
  ASSERT_TRUE(open()->append(std::vector{record(1), record(2)}));
  ASSERT_TRUE(open()->append(std::vector{record(3)}));
  EXPECT_THAT(numbers(*open(DatabaseAccess::Read)->read({})), ElementsAre(1, 2, 3));
}

TEST_P(Databases, FilterByApidServiceTextAndNumber) {
  auto database = open();
  std::vector<LogRecord> batch{record(1), record(2, LogKind::TelecommandRefused), record(3), record(4), record(5)};
  batch[1].peer = 12;
  batch[1].note = "wrong mode";
  batch[2].packet[7] = std::byte{8};
  batch[3].source = 42;
  batch[4].packet.clear();
  batch[4].source = 0;
  ASSERT_TRUE(database->append(batch));
  EXPECT_THAT(numbers(*database->read({.apid = 12})), ElementsAre(2));
  EXPECT_THAT(numbers(*database->read({.apid = 42})), ElementsAre(4));
  EXPECT_THAT(numbers(*database->read({.apid = 0x73})), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(numbers(*database->read({.service = 8})), ElementsAre(3));
  EXPECT_THAT(numbers(*database->read({.text = "wrong mode"})), ElementsAre(2));
  EXPECT_THAT(numbers(*database->read({.text = "TC[8,1]"})), ElementsAre(3));
  EXPECT_THAT(numbers(*database->read({.since = 4})), ElementsAre(4, 5));
  EXPECT_THAT(numbers(*database->read({.last = 2})), ElementsAre(4, 5));
  EXPECT_THAT(numbers(*database->read({.service = 17, .since = 2, .last = 1})), ElementsAre(4));
  EXPECT_THAT(numbers(*database->read({.last = 0})), IsEmpty());
}

TEST_P(Databases, TellRunsApart) {
  auto database = open();
  LogRecord later = record(1);
  later.run += 1s;
  ASSERT_TRUE(database->append(std::vector{record(1), record(2)}));
  ASSERT_TRUE(database->append(std::vector{later}));
  EXPECT_THAT(numbers(*database->read({})), ElementsAre(1, 2, 1));
  EXPECT_THAT(numbers(*database->read({.run = later.run})), ElementsAre(1));
}

TEST_P(Databases, ShowARepeatedRecordOnce) {
  auto database = open();
  ASSERT_TRUE(database->append(std::vector{record(1), record(2)}));
  ASSERT_TRUE(database->append(std::vector{record(2), record(3)}));
  EXPECT_THAT(numbers(*database->read({})), ElementsAre(1, 2, 3));
}

/// Each with words and octets of its own.
std::vector<LogRecord> many(std::uint64_t first, std::uint64_t last) {
  std::vector<LogRecord> all;
  for (std::uint64_t number = first; number <= last; ++number) {
    LogRecord& each = all.emplace_back(record(number, number % 3 == 0 ? LogKind::Event : LogKind::TelecommandReceived));
    each.source = static_cast<std::uint16_t>(number);
    each.note = Note{std::to_string(number)};
    each.packet.resize(number % 2 == 0 ? each.packet.size() : 0);
  }
  return all;
}

TEST_P(Databases, GiveBackLargeBatchesOfWhichSomeWasThereBefore) {
  auto database = open();
  ASSERT_TRUE(database->append(many(1, 33)));
  ASSERT_TRUE(database->append(many(20, 131)));
  EXPECT_EQ(database->read({})->records, many(1, 131));
}

TEST_P(Databases, RefuseAPacketLongerThanASpacePacket) {
  auto database = open();
  LogRecord huge = record(1);
  huge.packet.resize(Database::max_packet_octets + 1);
  ASSERT_FALSE(database->append(std::vector{huge}));
  EXPECT_THAT(numbers(*database->read({})), IsEmpty());
  EXPECT_TRUE(database->append(std::vector{record(1)}));
}

TEST_P(DatabasesOnDisk, CanBeReadWhileBeingWritten) {
  auto writer = open();
  auto reader = open(DatabaseAccess::Read);
  for (std::uint64_t number = 1; number <= 20; ++number) {
    ASSERT_TRUE(writer->append(std::vector{record(number)}));
    EXPECT_EQ(reader->read({})->records.size(), number);
  }
}

TEST_P(DatabasesOnDisk, OpenedForReadingStoreNothing) {
  EXPECT_EQ(open_database(GetParam(), path(), DatabaseAccess::Read).error().code, ErrorCode::NotFound);
  EXPECT_FALSE(std::filesystem::exists(path()));
  ASSERT_TRUE(open()->append(std::vector{record(1)}));
  EXPECT_EQ(open(DatabaseAccess::Read)->append(std::vector{record(2)}).error().code, ErrorCode::NotPermitted);
}

TEST_P(DatabasesOnDisk, ReportAFolderThatDoesNotExist) {
  EXPECT_FALSE(open_database(GetParam(), path() / "absent" / "log"));
}

const auto strategy_name = [](const auto& strategy) { return std::string{to_text(strategy.param)}; };
INSTANTIATE_TEST_SUITE_P(Strategies, Databases,
                         ::testing::Values(DatabaseStrategy::Sqlite, DatabaseStrategy::Ascii, DatabaseStrategy::Memory,
                                           DatabaseStrategy::Postgresql),
                         strategy_name);
INSTANTIATE_TEST_SUITE_P(Strategies, DatabasesOnDisk,
                         ::testing::Values(DatabaseStrategy::Sqlite, DatabaseStrategy::Ascii), strategy_name);

class OneDatabase : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "log"; }

 private:
  TestFolder folder_;
};
using Sqlite = OneDatabase;

/// Another program's hands on a SQLite file.
void execute(const std::filesystem::path& path, const char* sql) {
  sqlite3* connection = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &connection), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(connection, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(connection);
  sqlite3_close(connection);
}

TEST_F(Sqlite, LeavesAnotherProgramsFileAlone) {
  execute(path(), "CREATE TABLE t(x)");
  const auto database = open_database(DatabaseStrategy::Sqlite, path());
  ASSERT_FALSE(database);
  EXPECT_EQ(database.error().code, ErrorCode::Mismatch);
  EXPECT_STREQ(database.error().text, "not a log database of ours");
}

TEST_F(Sqlite, RefusesALaterSchema) {
  ASSERT_TRUE(open_database(DatabaseStrategy::Sqlite, path()));
  execute(path(), "PRAGMA user_version = 2");
  const auto database = open_database(DatabaseStrategy::Sqlite, path());
  ASSERT_FALSE(database);
  EXPECT_EQ(database.error().code, ErrorCode::Mismatch);
  EXPECT_EQ(database.error().value, 2);
  EXPECT_STREQ(database.error().text, "log database of another schema version");
}

/// TORQUE missed TORQUE_LIMIT_EXCEEDED, which only the words of a packet have, and case mattered.
TEST(LogSearch, FindsWhatIsShownWhateverItsCase) {
  const LogRecord stored = record(7);
  const auto finds = [&](std::string_view text, bool in_words) {
    LogQuery query{.text = std::string{text}};
    if (in_words)
      query.words = [](const LogRecord& one) {
        return std::to_string(one.number) + " TORQUE_LIMIT_EXCEEDED LIMIT=6 N m";
      };
    return matches(stored, query);
  };
  for (const char* text : {"", "TORQUE", "torque_limit", "limit=6 n m", "7 torque"})
    EXPECT_TRUE(finds(text, true)) << text;
  EXPECT_FALSE(finds("TORQUE", false)) << "no words of the packet are there to be searched";
  EXPECT_FALSE(finds("FORCE", true));
}

TEST_F(Sqlite, RefusesAFileThatIsNone) {
  std::ofstream{path()} << std::string(5000, 'x');
  EXPECT_FALSE(open_database(DatabaseStrategy::Sqlite, path()));
}

TEST_F(Sqlite, StoresAllOfABatchOrNothing) {
  auto database = std::move(*open_database(DatabaseStrategy::Sqlite, path()));
  ASSERT_TRUE(database->append(std::vector{record(5)}));
  LogRecord other = record(5);
  other.note = "other words";
  EXPECT_EQ(database->append(std::vector{record(4), other}).error().code, ErrorCode::AlreadyExists);
  EXPECT_THAT(numbers(*database->read({})), ElementsAre(5));
}

TEST_F(Sqlite, StoresAllOfALargeBatchOrNothing) {
  auto database = std::move(*open_database(DatabaseStrategy::Sqlite, path()));
  ASSERT_TRUE(database->append(many(50, 50)));
  auto batch = many(1, 64);
  batch[49].note = "other words";
  EXPECT_EQ(database->append(batch).error().code, ErrorCode::AlreadyExists);
  EXPECT_THAT(numbers(*database->read({})), ElementsAre(50));
}

TEST_F(Sqlite, AsksForAnotherTryWhileSomebodyElseHoldsTheLock) {
  auto database = std::move(*open_database(DatabaseStrategy::Sqlite, path()));
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(path().c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_EQ(database->append(std::vector{record(1)}).error().code, ErrorCode::Unavailable);
  ASSERT_EQ(sqlite3_exec(other, "COMMIT", nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(other);
  EXPECT_TRUE(database->append(std::vector{record(1)}));
}

/// A file system whose `sync` fails when told to: the default one behind a thin layer.
struct FailingDisk {
  struct File {
    sqlite3_file base;
    sqlite3_io_methods methods;
  };
  static inline int failures_left = 0;
  static inline int refuses_to_open = 0;  ///< why, as errno; 0 = it does not
  static inline sqlite3_vfs layer{};
  static inline sqlite3_vfs* real = nullptr;

  static sqlite3_file* inner(sqlite3_file* file) {
    return reinterpret_cast<sqlite3_file*>(reinterpret_cast<File*>(file) + 1);
  }
  template <auto member, class... Arguments>
  static auto pass(sqlite3_file* file, Arguments... arguments) {
    return (inner(file)->pMethods->*member)(inner(file), arguments...);
  }
  static int sync(sqlite3_file* file, int flags) {
    if (failures_left > 0) {
      --failures_left;
      return SQLITE_IOERR_FSYNC;
    }
    return inner(file)->pMethods->xSync(inner(file), flags);
  }
  static int open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
    auto* outer = reinterpret_cast<File*>(file);
    outer->base.pMethods = nullptr;
    if (refuses_to_open != 0) {
      errno = refuses_to_open;
      return SQLITE_CANTOPEN;
    }
    const int code = real->xOpen(real, name, inner(file), flags, out_flags);
    if (code != SQLITE_OK) return code;
    using M = sqlite3_io_methods;
    outer->methods = {.iVersion = 2,
                      .xClose = pass<&M::xClose>,
                      .xRead = pass<&M::xRead, void*, int, sqlite3_int64>,
                      .xWrite = pass<&M::xWrite, const void*, int, sqlite3_int64>,
                      .xTruncate = pass<&M::xTruncate, sqlite3_int64>,
                      .xSync = sync,
                      .xFileSize = pass<&M::xFileSize, sqlite3_int64*>,
                      .xLock = pass<&M::xLock, int>,
                      .xUnlock = pass<&M::xUnlock, int>,
                      .xCheckReservedLock = pass<&M::xCheckReservedLock, int*>,
                      .xFileControl = pass<&M::xFileControl, int, void*>,
                      .xSectorSize = pass<&M::xSectorSize>,
                      .xDeviceCharacteristics = pass<&M::xDeviceCharacteristics>,
                      .xShmMap = pass<&M::xShmMap, int, int, int, void volatile**>,
                      .xShmLock = pass<&M::xShmLock, int, int, int>,
                      .xShmBarrier = pass<&M::xShmBarrier>,
                      .xShmUnmap = pass<&M::xShmUnmap, int>,
                      .xFetch = nullptr,
                      .xUnfetch = nullptr};
    outer->base.pMethods = &outer->methods;
    return SQLITE_OK;
  }

  FailingDisk() {
    real = sqlite3_vfs_find(nullptr);
    layer = *real;
    layer.zName = "failing";
    layer.szOsFile = static_cast<int>(sizeof(File)) + real->szOsFile;
    layer.xOpen = open;
    sqlite3_vfs_register(&layer, 1);
  }
  ~FailingDisk() {
    sqlite3_vfs_unregister(&layer);
    sqlite3_vfs_register(real, 1);
    failures_left = refuses_to_open = 0;
  }
  FailingDisk(const FailingDisk&) = delete;
  FailingDisk& operator=(const FailingDisk&) = delete;
};

TEST_F(Sqlite, TellsADiskWithoutRoomForANewFileFromOneThatItMayNotWrite) {
  const FailingDisk disk;
  const auto refused = [&](int reason) {
    FailingDisk::refuses_to_open = reason;
    return open_database(DatabaseStrategy::Sqlite, path()).error();
  };
  EXPECT_EQ(refused(ENOSPC).code, ErrorCode::ResourceExhausted);
  EXPECT_EQ(refused(EACCES).code, ErrorCode::NotPermitted);
  EXPECT_EQ(refused(EACCES).value, SQLITE_CANTOPEN);
}

TEST_F(Sqlite, NeverTrustsADiskAgainWhoseSyncHasFailedOnce) {
  const FailingDisk disk;
  auto database = std::move(*open_database(DatabaseStrategy::Sqlite, path()));
  ASSERT_TRUE(database->append(std::vector{record(1)}));
  FailingDisk::failures_left = 1;
  const auto first = database->append(std::vector{record(2)});
  ASSERT_FALSE(first);
  EXPECT_EQ(first.error().code, ErrorCode::SystemFailure);
  EXPECT_EQ(first.error().value, SQLITE_IOERR_FSYNC);
  EXPECT_FALSE(database->append(std::vector{record(2)})) << "the next sync succeeds, which proves nothing";
  database.reset();
  auto next = std::move(*open_database(DatabaseStrategy::Sqlite, path()));
  ASSERT_TRUE(next->append(std::vector{record(2), record(3)}));
  EXPECT_THAT(numbers(*next->read({})), ElementsAre(1, 2, 3));
}

TEST(LogText, TellsWhoSentWhatToWhomAndWhatBecameOfIt) {
  LogRecord refused = record(12, LogKind::TelecommandRefused);
  refused.source = 0;
  refused.peer = 115;
  refused.note = "not permitted in this mode";
  refused.stored = OnboardTime{2'145'916'837s};
  EXPECT_EQ(describe(refused),
            "12 2026-01-01T00:00:37.000000000 telecommand-refused ground>115 TC[17,1] 13 octets: "
            "not permitted in this mode");
}

TEST(LogText, NotesArePrintableAndBounded) {
  EXPECT_EQ(Note{"a\nb\x80"}.view(), "a?b?");
  EXPECT_EQ(Note{std::string(500, 'a')}.view(), std::string(Note::capacity, 'a'));
}

TEST(LogText, TimesComeBackExactly) {
  for (const std::int64_t nanoseconds : {0L, 1L, 2'145'916'837'123'456'789L, 8'900'000'000'000'000'000L}) {
    const OnboardTime time{Duration{nanoseconds}};
    EXPECT_EQ(time_from_text(time_text(time)), time) << time_text(time);
  }
  EXPECT_EQ(time_text(OnboardTime{}), "1958-01-01T00:00:00.000000000");
  for (const char* text : {"", "2026-02-30T00:00:00.000000000", "2026-01-01T24:00:00.000000000",
                           "2026-01-01 00:00:00.000000000", "2026-01-01T00:00:00.000000000x"})
    EXPECT_FALSE(time_from_text(text)) << text;
}

}  // namespace
}  // namespace hirosco::supervisor
