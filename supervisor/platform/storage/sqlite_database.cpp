// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/sqlite_database.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <map>
#include <utility>

namespace hirosco::supervisor {

namespace {

constexpr const char* columns = "run, number, stored, monotonic, kind, source, peer, lost, note, packet";

/// A statement costs as much as what it stores: most records go by one for so many of them.
constexpr std::size_t records_at_once = 32;

std::string insertion_of(std::size_t records) {
  constexpr std::string_view values = "(?,?,?,?,?,?,?,?,?,?,?,?,?)";
  std::string sql = std::string{"INSERT INTO log ("} + columns + ", apid, service, subtype) VALUES ";
  for (std::size_t i = 0; i < records; ++i) sql.append(i == 0 ? "" : ",").append(values);
  return sql + " ON CONFLICT (run, number) DO NOTHING";
}

/// `reason`: what the operating system said.
Error error_from(const SQLite::Exception& refused, int reason, const char* what) {
  const int code = refused.getExtendedErrorCode();
  const int primary = code & 0xFF;
  if (primary == SQLITE_BUSY || primary == SQLITE_LOCKED) return {ErrorCode::Unavailable, what, code};
  if (primary == SQLITE_CORRUPT || primary == SQLITE_NOTADB) return {ErrorCode::Malformed, what, code};
  // A failed fsync leaves the file doubtful whatever the reason; any other call without space is only that.
  const bool synced = code == SQLITE_IOERR_FSYNC || code == SQLITE_IOERR_DIR_FSYNC;
  const bool no_space = primary == SQLITE_IOERR && !synced && (reason == ENOSPC || reason == EDQUOT);
  if (primary == SQLITE_FULL || no_space) return {ErrorCode::ResourceExhausted, what, code};
  if (primary == SQLITE_READONLY || primary == SQLITE_CANTOPEN || primary == SQLITE_PERM)
    return {reason == ENOSPC ? ErrorCode::ResourceExhausted : ErrorCode::NotPermitted, what, code};
  return {ErrorCode::SystemFailure, what, code};
}

std::int64_t nanoseconds(OnboardTime time) { return time.time_since_epoch().count(); }
std::int64_t nanoseconds(TimePoint time) { return time.time_since_epoch().count(); }

std::string_view text_of(const SQLite::Column& column) {
  return {column.getText(), static_cast<std::size_t>(column.getBytes())};
}

/// Lives as long as the program: SQLite takes no copy.
const std::string& name_of(LogKind kind) {
  static const auto names = [] {
    std::map<LogKind, std::string> all;
    for (const auto& [each, text] : EnumTexts<LogKind>::table) all.emplace(each, text);
    return all;
  }();
  return names.at(kind);
}

/// The record of a row; empty when somebody has put something into the file that is none.
std::optional<LogRecord> record_of(const SQLite::Statement& row) {
  const auto kind = from_text<LogKind>(text_of(row.getColumn(4)));
  if (!kind) return std::nullopt;
  LogRecord record{.run = OnboardTime{Duration{row.getColumn(0).getInt64()}},
                   .number = static_cast<std::uint64_t>(row.getColumn(1).getInt64()),
                   .stored = OnboardTime{Duration{row.getColumn(2).getInt64()}},
                   .monotonic = TimePoint{Duration{row.getColumn(3).getInt64()}},
                   .kind = *kind,
                   .source = row.getColumn(5),
                   .peer = row.getColumn(6),
                   .lost = row.getColumn(7),
                   .note = Note{text_of(row.getColumn(8))}};
  const SQLite::Column packet = row.getColumn(9);
  const auto* octets = static_cast<const std::byte*>(packet.getBlob());
  if (octets != nullptr) record.packet.assign(octets, octets + packet.getBytes());
  return record;
}

}  // namespace

Result<std::unique_ptr<Database>> SqliteDatabase::open(const std::filesystem::path& path, DatabaseAccess access) {
  const bool reading = access == DatabaseAccess::Read;
  if (reading && !std::filesystem::exists(path)) return fail(ErrorCode::NotFound, "no such log database");
  const int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE |
                    (reading ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  constexpr const char* what = "opening the log database";
  std::unique_ptr<SqliteDatabase> database;
  try {
    database.reset(new SqliteDatabase{path, flags});
    HIROSCO_TRY(database->set_up(access));
    return database;
  } catch (const SQLite::Exception& refused) {
    if (database) return fail(database->error_of(refused, what));
    // The handle went with its constructor; what it would have said of the system stands in errno still.
    if (refused.getErrorCode() == SQLITE_NOMEM) return fail(ErrorCode::ResourceExhausted, what, SQLITE_NOMEM);
    return fail(error_from(refused, errno, what));
  }
}

Error SqliteDatabase::error_of(const SQLite::Exception& refused, const char* what) const {
  return error_from(refused, sqlite3_system_errno(connection_.getHandle()), what);
}

Result<> SqliteDatabase::set_up(DatabaseAccess access) {
  empty_ = access == DatabaseAccess::Read &&
           connection_.execAndGet("SELECT count(*) FROM sqlite_schema").getInt() == 0 &&
           connection_.execAndGet("PRAGMA application_id").getInt() == 0;
  if (empty_) return ok();
  if (access == DatabaseAccess::Write) {
    HIROSCO_TRY(make_or_check_schema());
    insert_.emplace(connection_, insertion_of(1));
    insert_many_.emplace(connection_, insertion_of(records_at_once));
  }
  const std::int64_t version = connection_.execAndGet("PRAGMA user_version");
  const std::int64_t owner = connection_.execAndGet("PRAGMA application_id");
  if (owner != application_id) return fail(ErrorCode::Mismatch, "not a log database of ours", owner);
  if (version != schema_version) return fail(ErrorCode::Mismatch, "log database of another schema version", version);
  find_.emplace(connection_, std::string{"SELECT "} + columns + " FROM log WHERE run = ?1 AND number = ?2");
  return ok();
}

Result<> SqliteDatabase::make_or_check_schema() {
  const std::int64_t tables = connection_.execAndGet("SELECT count(*) FROM sqlite_schema");
  // A file that belongs to somebody else is left as it is.
  if (tables != 0) {
    const std::int64_t owner = connection_.execAndGet("PRAGMA application_id");
    if (owner != application_id) return fail(ErrorCode::Mismatch, "not a log database of ours", owner);
  }
  connection_.exec("PRAGMA journal_mode = WAL");
  connection_.exec("PRAGMA synchronous = FULL");
  if (tables != 0) return ok();
  SQLite::Transaction all{connection_, SQLite::TransactionBehavior::IMMEDIATE};
  connection_.exec(
      "CREATE TABLE IF NOT EXISTS log ("
      " position INTEGER PRIMARY KEY, run INTEGER NOT NULL, number INTEGER NOT NULL, stored INTEGER NOT NULL,"
      " monotonic INTEGER NOT NULL, kind TEXT NOT NULL, source INTEGER NOT NULL, peer INTEGER NOT NULL,"
      " lost INTEGER NOT NULL, note TEXT NOT NULL, packet BLOB NOT NULL, apid INTEGER, service INTEGER, subtype "
      "INTEGER,"
      " UNIQUE (run, number));"
      "PRAGMA application_id = 1213354819;"
      "PRAGMA user_version = 1");
  all.commit();
  return ok();
}
static_assert(SqliteDatabase::application_id == 1213354819 && SqliteDatabase::schema_version == 1);

Result<> SqliteDatabase::do_append(std::span<const LogRecord> batch) {
  if (!insert_) return fail(ErrorCode::NotPermitted, "this log is open for reading only");
  try {
    SQLite::Transaction all{connection_, SQLite::TransactionBehavior::IMMEDIATE};
    while (!batch.empty()) {
      const bool many = batch.size() >= records_at_once;
      const auto records = batch.first(many ? records_at_once : 1);
      HIROSCO_TRY(insert(many ? *insert_many_ : *insert_, records));
      batch = batch.subspan(records.size());
    }
    all.commit();
    return ok();
  } catch (const SQLite::Exception& refused) {
    return fail(error_of(refused, "storing in the log database"));
  }
}

Result<> SqliteDatabase::insert(SQLite::Statement& statement, std::span<const LogRecord> records) {
  static_cast<void>(statement.tryReset());   // whatever the one before came to
  std::array<std::string, records_at_once> notes;
  int column = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const LogRecord& record = records[i];
    const PacketLabel label = label_of(record.packet);
    notes[i] = record.note.view();
    // Without a pointer SQLite would take no octets for no value.
    const void* packet = record.packet.empty() ? "" : static_cast<const void*>(record.packet.data());
    statement.bind(++column, nanoseconds(record.run));
    statement.bind(++column, static_cast<std::int64_t>(record.number));
    statement.bind(++column, nanoseconds(record.stored));
    statement.bind(++column, nanoseconds(record.monotonic));
    statement.bindNoCopy(++column, name_of(record.kind));
    statement.bind(++column, record.source);
    statement.bind(++column, record.peer);
    statement.bind(++column, record.lost);
    statement.bindNoCopy(++column, notes[i]);
    statement.bindNoCopy(++column, packet, static_cast<int>(record.packet.size()));
    statement.bind(++column, label.apid);
    statement.bind(++column, label.service);
    statement.bind(++column, label.subtype);
  }
  if (statement.exec() == static_cast<int>(records.size())) return ok();
  for (const LogRecord& record : records) HIROSCO_TRY(check_same(record));
  return ok();
}

Result<> SqliteDatabase::check_same(const LogRecord& record) {
  static_cast<void>(find_->tryReset());
  find_->bind(1, nanoseconds(record.run));
  find_->bind(2, static_cast<std::int64_t>(record.number));
  const auto stored = find_->executeStep() ? record_of(*find_) : std::nullopt;
  find_->reset();   // with a row in hand it would keep its lock
  if (!stored || *stored != record)
    return fail(ErrorCode::AlreadyExists, "another record has this number", static_cast<std::int64_t>(record.number));
  return ok();
}

namespace {
/// Of one run there is an index by number.
const char* order_of(const LogQuery& query) {
  const bool oldest = query.end == LogEnd::Oldest;
  if (query.run) return oldest ? " ORDER BY number" : " ORDER BY number DESC";
  return oldest ? " ORDER BY position" : " ORDER BY position DESC";
}
}  // namespace

Result<LogPage> SqliteDatabase::do_read(const LogQuery& query) {
  if (empty_) {
    try {
      HIROSCO_TRY(set_up(DatabaseAccess::Read));
    } catch (const SQLite::Exception& refused) {
      return fail(error_of(refused, "reading the log database"));
    }
    if (empty_) return LogPage{};
  }
  // The statement narrows what is fetched; `matches` alone decides, as in every strategy.
  const bool oldest = query.end == LogEnd::Oldest;
  std::string sql = std::string{"SELECT "} + columns + " FROM log WHERE number >= ?1";
  if (query.run) sql += " AND run = ?2";
  if (query.apid) sql += " AND (source = ?3 OR peer = ?3 OR apid = ?3)";
  if (query.service) sql += " AND service = ?4";
  if (query.kind) sql += " AND kind = ?7";
  sql += " AND stored BETWEEN ?5 AND ?6";
  try {
    SQLite::Statement row{connection_, sql + order_of(query)};
    row.bind(1, static_cast<std::int64_t>(std::min<std::uint64_t>(query.since, INT64_MAX)));
    if (query.run) row.bind(2, nanoseconds(*query.run));
    if (query.apid) row.bind(3, *query.apid);
    if (query.service) row.bind(4, *query.service);
    row.bind(5, nanoseconds(query.stored_from));
    row.bind(6, nanoseconds(query.stored_to));
    if (query.kind) row.bind(7, std::string{to_text(*query.kind)});

    LogPage page;
    while (page.records.size() < query.last && row.executeStep()) {
      auto record = record_of(row);
      if (!record) ++page.damaged;
      else if (matches(*record, query)) page.records.push_back(std::move(*record));
    }
    if (!oldest) std::ranges::reverse(page.records);
    return page;
  } catch (const SQLite::Exception& refused) {
    return fail(error_of(refused, "reading the log database"));
  }
}

}  // namespace hirosco::supervisor
