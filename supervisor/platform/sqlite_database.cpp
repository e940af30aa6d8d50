// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/sqlite_database.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace hirosco::supervisor {

namespace {

constexpr const char* columns = "run, number, stored, monotonic, kind, source, peer, lost, note, packet";

Error error_of(sqlite3* connection, const char* what) {
  const int code = sqlite3_extended_errcode(connection);
  const int primary = code & 0xFF;
  if (primary == SQLITE_BUSY || primary == SQLITE_LOCKED) return {ErrorCode::Unavailable, what, code};
  if (primary == SQLITE_CORRUPT || primary == SQLITE_NOTADB) return {ErrorCode::Malformed, what, code};
  // A failed fsync leaves the file doubtful whatever the reason; any other call without space is only that.
  const bool synced = code == SQLITE_IOERR_FSYNC || code == SQLITE_IOERR_DIR_FSYNC;
  const int reason = sqlite3_system_errno(connection);
  const bool no_space = primary == SQLITE_IOERR && !synced && (reason == ENOSPC || reason == EDQUOT);
  if (primary == SQLITE_FULL || no_space) return {ErrorCode::ResourceExhausted, what, code};
  if (primary == SQLITE_READONLY || primary == SQLITE_CANTOPEN || primary == SQLITE_PERM)
    return {reason == ENOSPC ? ErrorCode::ResourceExhausted : ErrorCode::NotPermitted, what, code};
  return {ErrorCode::SystemFailure, what, code};
}

std::int64_t nanoseconds(OnboardTime time) { return time.time_since_epoch().count(); }
std::int64_t nanoseconds(TimePoint time) { return time.time_since_epoch().count(); }

/// Puts a statement back to its start, however the function is left: an unfinished one would keep its lock.
class Rewind {
 public:
  explicit Rewind(sqlite3_stmt* statement) : statement_{statement} {}
  ~Rewind() { sqlite3_reset(statement_); }
  Rewind(const Rewind&) = delete;
  Rewind& operator=(const Rewind&) = delete;

 private:
  sqlite3_stmt* statement_;
};

std::string_view text_column(sqlite3_stmt* row, int column) {
  const unsigned char* text = sqlite3_column_text(row, column);
  if (text == nullptr) return {};
  return {reinterpret_cast<const char*>(text), static_cast<std::size_t>(sqlite3_column_bytes(row, column))};
}

/// The record of a row; empty when somebody has put something into the file that is none.
std::optional<LogRecord> record_of(sqlite3_stmt* row) {
  const auto kind = from_text<LogKind>(text_column(row, 4));
  if (!kind) return std::nullopt;
  LogRecord record{.run = OnboardTime{Duration{sqlite3_column_int64(row, 0)}},
                   .number = static_cast<std::uint64_t>(sqlite3_column_int64(row, 1)),
                   .stored = OnboardTime{Duration{sqlite3_column_int64(row, 2)}},
                   .monotonic = TimePoint{Duration{sqlite3_column_int64(row, 3)}},
                   .kind = *kind,
                   .source = static_cast<std::uint16_t>(sqlite3_column_int(row, 5)),
                   .peer = static_cast<std::uint16_t>(sqlite3_column_int(row, 6)),
                   .lost = static_cast<std::uint32_t>(sqlite3_column_int64(row, 7)),
                   .note = Note{text_column(row, 8)}};
  const auto* octets = static_cast<const std::byte*>(sqlite3_column_blob(row, 9));
  const auto count = static_cast<std::size_t>(sqlite3_column_bytes(row, 9));
  if (octets != nullptr) record.packet.assign(octets, octets + count);
  return record;
}

}  // namespace

void SqliteDatabase::Close::operator()(sqlite3* connection) const noexcept { sqlite3_close_v2(connection); }
void SqliteDatabase::Close::operator()(sqlite3_stmt* statement) const noexcept { sqlite3_finalize(statement); }

Result<std::unique_ptr<Database>> SqliteDatabase::open(const std::filesystem::path& path, DatabaseAccess access) {
  const bool reading = access == DatabaseAccess::Read;
  if (reading && !std::filesystem::exists(path)) return fail(ErrorCode::NotFound, "no such log database");
  const int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE |
                    (reading ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &raw, flags, nullptr);
  Connection connection{raw};
  if (raw == nullptr) return fail(ErrorCode::ResourceExhausted, "no memory for the log database", code);
  if (code != SQLITE_OK) return fail(error_of(raw, "opening the log database"));
  std::unique_ptr<SqliteDatabase> database{new SqliteDatabase{std::move(connection)}};
  HIROSCO_TRY(database->set_up(access));
  return database;
}

Result<> SqliteDatabase::set_up(DatabaseAccess access) {
  sqlite3_busy_timeout(connection_.get(), busy_limit_ms);
  if (access == DatabaseAccess::Write) {
    HIROSCO_TRY(make_or_check_schema());
    HIROSCO_TRY_LET(insert_,
                    prepare("INSERT INTO log (run, number, stored, monotonic, kind, source, peer, lost, note, packet, "
                            "apid, service, subtype) VALUES (?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13) "
                            "ON CONFLICT (run, number) DO NOTHING"));
  }
  HIROSCO_TRY_LET(const std::int64_t version, number_from("PRAGMA user_version"));
  HIROSCO_TRY_LET(const std::int64_t owner, number_from("PRAGMA application_id"));
  if (owner != application_id) return fail(ErrorCode::Mismatch, "not a log database of ours", owner);
  if (version != schema_version) return fail(ErrorCode::Mismatch, "log database of another schema version", version);
  HIROSCO_TRY_LET(find_,
                  prepare((std::string{"SELECT "} + columns + " FROM log WHERE run = ?1 AND number = ?2").c_str()));
  return ok();
}

Result<> SqliteDatabase::make_or_check_schema() {
  HIROSCO_TRY_LET(const std::int64_t tables, number_from("SELECT count(*) FROM sqlite_schema"));
  // A file that belongs to somebody else is left as it is.
  if (tables != 0) {
    HIROSCO_TRY_LET(const std::int64_t owner, number_from("PRAGMA application_id"));
    if (owner != application_id) return fail(ErrorCode::Mismatch, "not a log database of ours", owner);
  }
  HIROSCO_TRY(run("PRAGMA journal_mode = WAL"));
  HIROSCO_TRY(run("PRAGMA synchronous = FULL"));
  if (tables != 0) return ok();
  return run(
      "BEGIN IMMEDIATE;"
      "CREATE TABLE IF NOT EXISTS log ("
      " position INTEGER PRIMARY KEY, run INTEGER NOT NULL, number INTEGER NOT NULL, stored INTEGER NOT NULL,"
      " monotonic INTEGER NOT NULL, kind TEXT NOT NULL, source INTEGER NOT NULL, peer INTEGER NOT NULL,"
      " lost INTEGER NOT NULL, note TEXT NOT NULL, packet BLOB NOT NULL, apid INTEGER, service INTEGER, subtype "
      "INTEGER,"
      " UNIQUE (run, number));"
      "PRAGMA application_id = 1213354819;"
      "PRAGMA user_version = 1;"
      "COMMIT");
}
static_assert(SqliteDatabase::application_id == 1213354819 && SqliteDatabase::schema_version == 1);

Result<> SqliteDatabase::run(const char* sql) {
  if (sqlite3_exec(connection_.get(), sql, nullptr, nullptr, nullptr) == SQLITE_OK) return ok();
  const Error error = error_of(connection_.get(), "log database");
  if (sqlite3_get_autocommit(connection_.get()) == 0)
    sqlite3_exec(connection_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
  return fail(error);
}

Result<std::int64_t> SqliteDatabase::number_from(const char* sql) {
  HIROSCO_TRY_LET(const Statement statement, prepare(sql));
  if (sqlite3_step(statement.get()) != SQLITE_ROW) return fail(error_of(connection_.get(), "reading the log database"));
  return sqlite3_column_int64(statement.get(), 0);
}

Result<SqliteDatabase::Statement> SqliteDatabase::prepare(const char* sql) {
  sqlite3_stmt* raw = nullptr;
  const int code = sqlite3_prepare_v3(connection_.get(), sql, -1, SQLITE_PREPARE_PERSISTENT, &raw, nullptr);
  Statement statement{raw};
  if (code != SQLITE_OK) return fail(error_of(connection_.get(), "preparing a statement of the log database"));
  return statement;
}

Result<> SqliteDatabase::do_append(std::span<const LogRecord> batch) {
  if (!insert_) return fail(ErrorCode::NotPermitted, "this log is open for reading only");
  HIROSCO_TRY(run("BEGIN IMMEDIATE"));
  for (const LogRecord& record : batch) {
    if (const Result<> stored = insert(record); !stored) {
      sqlite3_exec(connection_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
      return stored;
    }
  }
  return run("COMMIT");
}

Result<> SqliteDatabase::insert(const LogRecord& record) {
  sqlite3_stmt* row = insert_.get();
  const Rewind rewind{row};
  const PacketLabel label = label_of(record.packet);
  const std::string_view kind = to_text(record.kind);
  const std::string_view note = record.note.view();
  sqlite3_bind_int64(row, 1, nanoseconds(record.run));
  sqlite3_bind_int64(row, 2, static_cast<std::int64_t>(record.number));
  sqlite3_bind_int64(row, 3, nanoseconds(record.stored));
  sqlite3_bind_int64(row, 4, nanoseconds(record.monotonic));
  sqlite3_bind_text(row, 5, kind.data(), static_cast<int>(kind.size()), SQLITE_STATIC);
  sqlite3_bind_int(row, 6, record.source);
  sqlite3_bind_int(row, 7, record.peer);
  sqlite3_bind_int64(row, 8, record.lost);
  sqlite3_bind_text(row, 9, note.data(), static_cast<int>(note.size()), SQLITE_STATIC);
  if (record.packet.empty()) sqlite3_bind_zeroblob(row, 10, 0);
  else sqlite3_bind_blob(row, 10, record.packet.data(), static_cast<int>(record.packet.size()), SQLITE_STATIC);
  sqlite3_bind_int(row, 11, label.apid);
  sqlite3_bind_int(row, 12, label.service);
  sqlite3_bind_int(row, 13, label.subtype);
  if (sqlite3_step(row) != SQLITE_DONE) return fail(error_of(connection_.get(), "storing a record"));
  return sqlite3_changes(connection_.get()) == 0 ? check_same(record) : ok();
}

Result<> SqliteDatabase::check_same(const LogRecord& record) {
  sqlite3_stmt* row = find_.get();
  const Rewind rewind{row};
  sqlite3_bind_int64(row, 1, nanoseconds(record.run));
  sqlite3_bind_int64(row, 2, static_cast<std::int64_t>(record.number));
  if (sqlite3_step(row) != SQLITE_ROW) return fail(error_of(connection_.get(), "finding a record"));
  const auto stored = record_of(row);
  if (!stored || *stored != record)
    return fail(ErrorCode::AlreadyExists, "another record has this number", static_cast<std::int64_t>(record.number));
  return ok();
}

Result<LogPage> SqliteDatabase::do_read(const LogQuery& query) {
  // The statement narrows what is fetched; `matches` alone decides, as in every strategy.
  std::string sql = std::string{"SELECT "} + columns + " FROM log WHERE number >= ?1";
  if (query.run) sql += " AND run = ?2";
  if (query.apid) sql += " AND (source = ?3 OR peer = ?3 OR apid = ?3)";
  if (query.service) sql += " AND service = ?4";
  HIROSCO_TRY_LET(const Statement statement, prepare((sql + " ORDER BY position DESC").c_str()));
  sqlite3_stmt* row = statement.get();
  sqlite3_bind_int64(row, 1, static_cast<std::int64_t>(std::min<std::uint64_t>(query.since, INT64_MAX)));
  if (query.run) sqlite3_bind_int64(row, 2, nanoseconds(*query.run));
  if (query.apid) sqlite3_bind_int(row, 3, *query.apid);
  if (query.service) sqlite3_bind_int(row, 4, *query.service);

  LogPage page;
  int code = SQLITE_DONE;
  while (page.records.size() < query.last && (code = sqlite3_step(row)) == SQLITE_ROW) {
    auto record = record_of(row);
    if (!record) ++page.damaged;
    else if (matches(*record, query)) page.records.push_back(std::move(*record));
  }
  if (code != SQLITE_DONE && code != SQLITE_ROW) return fail(error_of(connection_.get(), "reading the log database"));
  std::ranges::reverse(page.records);
  return page;
}

}  // namespace hirosco::supervisor
