// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/postgresql_database.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <optional>
#include <thread>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/testing/slice.hpp"
#include "supervisor/platform/storage/begin_log.hpp"
#include "supervisor/platform/storage/log_store.hpp"
#include "supervisor/platform/storage/packet_log.hpp"
#include "supervisor/platform/storage/testing/batches.hpp"
#include "supervisor/platform/storage/testing/postgresql_server.hpp"
#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::HasSubstr;

/// A real server, to which all that happens that happens to servers.
class PostgresqlLog : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(PostgresqlServer::installed()) << "`testing/with_server` does not come here without one";
    std::string why_not;
    server_ = PostgresqlServer::shared(why_not);
    ASSERT_NE(server_, nullptr) << why_not;
  }
  [[nodiscard]] std::unique_ptr<Database> open(Duration limit = 20s) const {
    return std::move(*open_postgresql({.connection = server_->connection(), .log = log_name(log()), .limit = limit}));
  }
  [[nodiscard]] std::filesystem::path log() const { return folder_.path() / "log.db"; }
  [[nodiscard]] LogPage page() const {
    const auto reader = std::move(*open_postgresql(
        {.connection = server_->connection(), .log = log_name(log()), .limit = 20s}, DatabaseAccess::Read));
    return *reader->read({.last = 1'000'000});
  }
  /// Tries as the writer thread does, until the server is there again.
  static void append_at_last(Database& database, const std::vector<LogRecord>& batch) {
    for (int i = 0; i < 1000; ++i) {
      const auto stored = database.append(batch);
      if (stored) return;
      ASSERT_EQ(stored.error().code, ErrorCode::Unavailable) << stored.error().text;
    }
    FAIL() << database.trouble().text;
  }
  void expect_each_once(std::uint64_t last) const {
    const LogPage all = page();
    ASSERT_EQ(all.records.size(), last);
    for (std::uint64_t i = 0; i < last; ++i) ASSERT_EQ(all.records[i].number, i + 1);
  }
  TestFolder folder_;
  PostgresqlServer* server_{nullptr};
};

TEST_F(PostgresqlLog, RefusesAnotherRecordOfTheSameNumberAndStoresNothingOfItsBatch) {
  const auto database = open();
  ASSERT_TRUE(database->append(batch_of(1, 3)));
  auto other = batch_of(3, 4);
  other[0].note = "somebody else's";
  const auto refused = database->append(other);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::AlreadyExists);
  EXPECT_EQ(refused.error().value, 3);
  expect_each_once(3);
}

TEST_F(PostgresqlLog, KeepsLogsOfSeveralFlightsApart) {
  ASSERT_TRUE(open()->append(batch_of(1, 3)));
  const auto other = std::move(*open_postgresql({.connection = server_->connection(), .log = "/another"}));
  ASSERT_TRUE(other->append(batch_of(1, 1)));
  expect_each_once(3);
}

/// The statement lies in the frozen server's socket: when it thaws it is carried out for a client that has long gone.
TEST_F(PostgresqlLog, AFrozenServerIsGivenUpInTimeAndWhatItDoesLaterIsNotThereTwice) {
  const auto database = open(200ms);
  append_at_last(*database, batch_of(1, 10));
  server_->signal(SIGSTOP);
  for (int i = 0; i < 3; ++i) {
    const auto stored = database->append(batch_of(11, 20));
    ASSERT_FALSE(stored);
    EXPECT_EQ(stored.error().code, ErrorCode::Unavailable);
  }
  EXPECT_EQ(database->trouble().fault, StoreFault::Unreachable);
  EXPECT_EQ(database->trouble().count, 1U) << "said once";
  EXPECT_TRUE(database->trouble().present);
  server_->signal(SIGCONT);
  append_at_last(*database, batch_of(11, 20));
  append_at_last(*database, batch_of(21, 30));
  EXPECT_FALSE(database->trouble().present);
  expect_each_once(30);
}

/// A server that takes its time for a statement, of a supervisor that is killed meanwhile: nobody waits for its answer any more.
TEST_F(PostgresqlLog, WhatOneThatDiedHadSentIsThereBeforeTheNextOneAsksHowFarTheLogHasCome) {
  {
    const auto database = open();
    ASSERT_TRUE(database->append(batch_of(1, 10)));
  }
  ASSERT_EQ(server_->sql(
                "CREATE FUNCTION slow() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN IF NEW.number = 20 THEN PERFORM "
                "pg_sleep(1); END IF; RETURN NEW; END $$; CREATE TRIGGER slow BEFORE INSERT ON hirosco_log FOR EACH "
                "ROW EXECUTE FUNCTION slow(); SELECT 'done'"),
            "done\n");
  {
    const auto dying = open(700ms);
    append_at_last(*dying, batch_of(1, 10));  // it has its turn
    ASSERT_EQ(dying->append(batch_of(11, 20)).error().code, ErrorCode::Unavailable);
  }
  const auto next = open();
  const LogResumption noted{.run = batch_of(1, 1)[0].run, .last = 25, .durable = 10};
  std::optional<LogResumption> found;
  for (int i = 0; i < 1000 && !found; ++i) found = resumption_in(*next, noted, 1 << 20);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->durable, 20U)
      << "else these would count as lost, and the gap of them would have the number of one that is there";
  EXPECT_TRUE(next->append(batch_of(21, 25)));
  ASSERT_EQ(server_->sql("DROP FUNCTION slow CASCADE; SELECT 'done'"), "done\n");
  expect_each_once(25);
}

TEST_F(PostgresqlLog, ASessionThatDoesNotEndByItselfIsEnded) {
  const auto forgotten = open();
  ASSERT_TRUE(forgotten->append(batch_of(1, 10)));
  const auto next = open(1s);
  append_at_last(*next, batch_of(11, 20));
  EXPECT_EQ(next->trouble().count, 1U) << "told, and over";
  EXPECT_FALSE(next->trouble().present);
  expect_each_once(20);
}

TEST_F(PostgresqlLog, AKilledServerIsUsedAgainWhenItIsBackAndHasAllThatWasAcknowledged) {
  const auto database = open();
  ASSERT_TRUE(database->append(batch_of(1, 10)));
  server_->kill();
  EXPECT_EQ(database->append(batch_of(11, 20)).error().code, ErrorCode::Unavailable);
  EXPECT_EQ(database->append(batch_of(11, 20)).error().code, ErrorCode::Unavailable);
  EXPECT_THAT(database->trouble().text, HasSubstr("resumes by itself"));
  ASSERT_TRUE(server_->start());
  append_at_last(*database, batch_of(11, 20));
  server_->stop();
  EXPECT_FALSE(database->append(batch_of(21, 30)));
  ASSERT_TRUE(server_->start());
  append_at_last(*database, batch_of(21, 30));
  expect_each_once(30);
}

TEST_F(PostgresqlLog, AConnectionCutByTheServerIsMadeAgain) {
  const auto database = open();
  ASSERT_TRUE(database->append(batch_of(1, 10)));
  ASSERT_FALSE(server_->sql("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = 'hirosco'")
                   .empty());
  append_at_last(*database, batch_of(11, 20));
  EXPECT_EQ(database->trouble().count, 1U);
  expect_each_once(20);
}

TEST_F(PostgresqlLog, AFullDiskOfTheServerIsToldAndStoringResumesByItself) {
  const auto database = open();
  ASSERT_TRUE(database->append(batch_of(1, 10)));
  ASSERT_EQ(
      server_->sql(
          "CREATE FUNCTION full_disk() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RAISE EXCEPTION 'could not extend "
          "file' USING ERRCODE = '53100'; END $$; CREATE TRIGGER full_disk BEFORE INSERT ON hirosco_log "
          "EXECUTE FUNCTION full_disk(); SELECT 'done'"),
      "done\n");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(database->append(batch_of(11, 20)).error().code, ErrorCode::Unavailable);
  EXPECT_EQ(database->trouble().fault, StoreFault::Full);
  EXPECT_EQ(database->trouble().count, 1U);
  EXPECT_THAT(database->trouble().text, HasSubstr("could not extend file"));
  ASSERT_EQ(server_->sql("DROP FUNCTION full_disk CASCADE; SELECT 'done'"), "done\n");
  append_at_last(*database, batch_of(11, 20));
  expect_each_once(20);
}

TEST_F(PostgresqlLog, RecordsDeletedUnderItAreOneGapOfExactlyThese) {
  for (const std::string statement :
       {"DELETE FROM hirosco_log", "DELETE FROM hirosco_log WHERE number > 6", "DROP TABLE hirosco_log"}) {
    SCOPED_TRACE(statement);
    const auto database = std::move(*open_postgresql({.connection = server_->connection(),
                                                      .log = log_name(log()) + std::to_string(statement.size()),
                                                      .limit = 20s}));
    ASSERT_TRUE(database->append(batch_of(1, 10)));
    ASSERT_EQ(server_->sql(statement + "; SELECT 'done'"), "done\n");
    append_at_last(*database, batch_of(11, 12));
    EXPECT_EQ(covered(*database->read({})), 12U);
    EXPECT_EQ(database->trouble().fault, StoreFault::Deleted);
    EXPECT_EQ(database->trouble().lost, statement.ends_with('6') ? 4U : 10U);
    append_at_last(*database, batch_of(13, 14));
    EXPECT_EQ(covered(*database->read({})), 14U);
  }
}

TEST_F(PostgresqlLog, AServerThatSyncsNothingIsNoPlaceForALog) {
  server_->stop();
  ASSERT_TRUE(server_->start("fsync=off"));
  const auto database = open();
  EXPECT_EQ(database->append(batch_of(1, 1)).error().code, ErrorCode::Unavailable);
  EXPECT_EQ(database->trouble().fault, StoreFault::Unwritable);
  EXPECT_THAT(database->trouble().text, HasSubstr("fsync is off"));
  server_->stop();
  ASSERT_TRUE(server_->start());
  append_at_last(*database, batch_of(1, 1));
}

TEST_F(PostgresqlLog, WhatTheServerRefusesIsSaidInItsWords) {
  const auto database =
      std::move(*open_postgresql({.connection = server_->connection() + " dbname=absent", .log = "l", .limit = 20s}));
  EXPECT_EQ(database->append(batch_of(1, 1)).error().code, ErrorCode::Unavailable);
  EXPECT_THAT(database->trouble().text, HasSubstr("absent"));
}

TEST_F(PostgresqlLog, ATableOfAnotherVersionIsLeftAlone) {
  ASSERT_TRUE(open()->append(batch_of(1, 1)));
  ASSERT_EQ(server_->sql("COMMENT ON TABLE hirosco_log IS 'HIROSCO packet log, version 9'; SELECT 'done'"), "done\n");
  const auto database = open();
  EXPECT_FALSE(database->append(batch_of(2, 2)));
  EXPECT_THAT(database->trouble().text, HasSubstr("version 9"));
  ASSERT_EQ(server_->sql("COMMENT ON TABLE hirosco_log IS 'HIROSCO packet log, version 1'; SELECT 'done'"), "done\n");
  expect_each_once(1);
}

/// Telecommands as fast as the log takes them, from a thread of its own, until it is told to end.
class Load {
 public:
  explicit Load(PacketLog& log)
      : thread_{[this, &log] {
          const std::vector<std::byte> packet(40, std::byte{0x5A});
          while (!ends_) {
            const auto number = log.append({.kind = LogKind::TelecommandReceived, .peer = 11, .packet = packet});
            if (number != 0) last_ = number;
            while (!ends_ && log.durable() + 3000 < last_) std::this_thread::yield();
          }
        }} {}
  ~Load() { end(); }
  std::uint64_t end() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
    return last_;
  }
  [[nodiscard]] std::uint64_t last() const { return last_; }

 private:
  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> last_{0};
  std::thread thread_;
};

TEST_F(PostgresqlLog, ASwitchUnderLoadBetweenAllStrategiesInAllDirectionsLosesAndDoublesNothing) {
  using enum DatabaseStrategy;
  const SystemClock clock;
  const auto make = [&](DatabaseStrategy strategy) -> std::unique_ptr<Database> {
    if (strategy == DatabaseStrategy::Postgresql) return open();
    return std::make_unique<LogStore>(strategy, log(), LogLimits{.rotate_octets = 200'000});
  };
  const std::uint64_t each = 1500 / hirosco::testing::one_in(5U);
  std::uint64_t last = 0;
  {
    ThreadedPacketLog packets{clock, make(Sqlite), {.flush_limit = 60s}};
    {
      Load load{packets};
      for (const DatabaseStrategy next :
           {DatabaseStrategy::Postgresql, Ascii, Sqlite, Ascii, DatabaseStrategy::Postgresql, Sqlite,
            DatabaseStrategy::Postgresql, DatabaseStrategy::Postgresql, Ascii, Ascii, Sqlite}) {
        // What this database has stored: a switch that another one overtakes opens nothing.
        const std::uint64_t until = load.last() + each;
        while (packets.durable() < until) std::this_thread::yield();
        packets.switch_to(make(next));
      }
      last = std::max(load.end(), packets.counters().accepted);
    }
    ASSERT_TRUE(packets.flush(60s));
    EXPECT_EQ(packets.counters().refused, 0U);
    EXPECT_EQ(packets.counters().switches, 11U);
  }
  Database* const server = open().release();
  const std::unique_ptr<Database> owned{server};
  const auto all = read_log(log(), {.last = 1'000'000}, std::span{&server, 1});
  ASSERT_TRUE(all);
  ASSERT_EQ(all->records.size(), last);
  for (std::uint64_t i = 0; i < last; ++i) ASSERT_EQ(all->records[i].number, i + 1);
  const auto in_server = server->read({.last = 1'000'000});
  ASSERT_TRUE(in_server) << in_server.error().text;
  std::size_t stored = in_server->records.size();
  EXPECT_GT(stored, 4 * each * 2 / 3);
  for (const LogPiece& piece : pieces_of(log()))
    stored +=
        (*open_database(piece.strategy, piece.path, DatabaseAccess::Read))->read({.last = 1'000'000})->records.size();
  EXPECT_EQ(stored, last) << "each stands in one place";
}

TEST_F(PostgresqlLog, UnderLoadNothingIsLostOrDoubledWhateverHappensToTheServer) {
  const SystemClock clock;
  std::uint64_t last = 0;
  {
    ThreadedPacketLog packets{clock, open(300ms), {.flush_limit = 60s}};
    Load load{packets};
    const auto run_on = [&] {
      const std::uint64_t until = packets.durable() + 2000;
      while (packets.durable() < until) std::this_thread::yield();
    };
    const int rounds = 3 / hirosco::testing::one_in(3);
    for (int i = 0; i < rounds; ++i) {
      run_on();
      server_->kill();
      ASSERT_TRUE(server_->start());
      run_on();
      server_->signal(SIGSTOP);
      while (!packets.trouble().present) std::this_thread::yield();
      server_->signal(SIGCONT);
      run_on();
      static_cast<void>(
          server_->sql("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE application_name = 'hirosco'"));
    }
    run_on();
    last = load.end();
    const TimePoint deadline = clock.now() + 60s;
    while (packets.durable() < last && clock.now() < deadline) std::this_thread::yield();
    EXPECT_EQ(packets.counters().refused, 0U);
    EXPECT_GE(packets.trouble().count, 2U * static_cast<unsigned>(rounds));
  }
  expect_each_once(last);
}

}  // namespace
}  // namespace hirosco::supervisor
