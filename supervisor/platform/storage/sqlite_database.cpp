// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/sqlite_database.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace hirosco::supervisor {

namespace {

constexpr const char* columns = "run, number, stored, monotonic, kind, source, peer, lost, note, packet";

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
    insert_.emplace(connection_,
                    "INSERT INTO log (run, number, stored, monotonic, kind, source, peer, lost, note, packet, "
                    "apid, service, subtype) VALUES (?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13) "
                    "ON CONFLICT (run, number) DO NOTHING");
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
    for (const LogRecord& record : batch) HIROSCO_TRY(insert(record));
    all.commit();
    return ok();
  } catch (const SQLite::Exception& refused) {
    return fail(error_of(refused, "storing in the log database"));
  }
}

Result<> SqliteDatabase::insert(const LogRecord& record) {
  const PacketLabel label = label_of(record.packet);
  const std::string kind{to_text(record.kind)};
  const std::string note{record.note.view()};
  // Without a pointer SQLite would take no octets for no value.
  const void* packet = record.packet.empty() ? "" : static_cast<const void*>(record.packet.data());
  static_cast<void>(insert_->tryReset());   // whatever the one before came to
  insert_->bind(1, nanoseconds(record.run));
  insert_->bind(2, static_cast<std::int64_t>(record.number));
  insert_->bind(3, nanoseconds(record.stored));
  insert_->bind(4, nanoseconds(record.monotonic));
  insert_->bindNoCopy(5, kind);
  insert_->bind(6, record.source);
  insert_->bind(7, record.peer);
  insert_->bind(8, record.lost);
  insert_->bindNoCopy(9, note);
  insert_->bindNoCopy(10, packet, static_cast<int>(record.packet.size()));
  insert_->bind(11, label.apid);
  insert_->bind(12, label.service);
  insert_->bind(13, label.subtype);
  return insert_->exec() == 0 ? check_same(record) : ok();
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
