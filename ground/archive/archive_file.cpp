// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/archive/archive_file.hpp"

#include <sqlite3.h>

#include <algorithm>

namespace hirosco::ground {
namespace {

constexpr const char* schema = R"(
  PRAGMA journal_mode=WAL;
  PRAGMA synchronous=NORMAL;
  PRAGMA auto_vacuum=NONE;
  CREATE TABLE IF NOT EXISTS packets(id INTEGER PRIMARY KEY, t INTEGER NOT NULL, apid INTEGER NOT NULL,
    service INTEGER NOT NULL, subtype INTEGER NOT NULL, sid INTEGER NOT NULL, octets BLOB NOT NULL);
  CREATE INDEX IF NOT EXISTS packets_by_time ON packets(t);
  CREATE INDEX IF NOT EXISTS packets_but_housekeeping ON packets(t) WHERE sid = 0;
  CREATE INDEX IF NOT EXISTS packets_by_structure ON packets(apid, sid, t) WHERE sid != 0;
  CREATE TABLE IF NOT EXISTS events(id INTEGER PRIMARY KEY, t INTEGER NOT NULL, apid INTEGER NOT NULL,
    subsystem TEXT NOT NULL, event INTEGER NOT NULL, name TEXT NOT NULL, severity INTEGER NOT NULL, text TEXT NOT NULL,
    vals TEXT NOT NULL);
  CREATE INDEX IF NOT EXISTS events_by_time ON events(t);
  CREATE TABLE IF NOT EXISTS commands(id INTEGER PRIMARY KEY AUTOINCREMENT, t INTEGER NOT NULL, sender TEXT NOT NULL,
    apid INTEGER NOT NULL, subsystem TEXT NOT NULL, function TEXT NOT NULL, arguments TEXT NOT NULL,
    stage TEXT NOT NULL, code INTEGER, reason TEXT NOT NULL);
  CREATE INDEX IF NOT EXISTS commands_by_time ON commands(t);
  CREATE TABLE IF NOT EXISTS reports(id INTEGER PRIMARY KEY, command INTEGER NOT NULL, t INTEGER NOT NULL,
    stage TEXT NOT NULL, code INTEGER, reason TEXT NOT NULL);
  CREATE INDEX IF NOT EXISTS reports_by_command ON reports(command);
  CREATE INDEX IF NOT EXISTS reports_by_time ON reports(t);
  CREATE TABLE IF NOT EXISTS changes(id INTEGER PRIMARY KEY, t INTEGER NOT NULL, kind TEXT NOT NULL, name TEXT NOT NULL,
    value TEXT NOT NULL);
  CREATE INDEX IF NOT EXISTS changes_by_time ON changes(t);
  CREATE INDEX IF NOT EXISTS changes_by_name ON changes(kind, name, t);
  CREATE TABLE IF NOT EXISTS gaps(id INTEGER PRIMARY KEY, t INTEGER NOT NULL, until INTEGER NOT NULL);
  CREATE TABLE IF NOT EXISTS faults(id INTEGER PRIMARY KEY, t INTEGER NOT NULL, device TEXT NOT NULL,
    line TEXT NOT NULL, answer TEXT NOT NULL);
  CREATE TABLE IF NOT EXISTS marks(id INTEGER PRIMARY KEY, t INTEGER NOT NULL, kind TEXT NOT NULL, name TEXT NOT NULL,
    action TEXT NOT NULL, who TEXT NOT NULL, note TEXT NOT NULL, until INTEGER NOT NULL);
  CREATE INDEX IF NOT EXISTS marks_by_time ON marks(t);
)";
/// Written once, so that nobody's other file is filled and no other version is misread.
constexpr const char* mark = "PRAGMA application_id = 1213417281; PRAGMA user_version = 1";
constexpr std::int64_t application_id = 1213417281;  ///< "HSGA"
constexpr std::int64_t schema_version = 1;
constexpr int busy_limit_ms = 2000;  ///< while opening

}  // namespace

ArchiveFile::ArchiveFile(const std::string& path, std::int64_t limit_octets)
    : database_{path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, busy_limit_ms}, limit_octets_{limit_octets} {}

ArchiveFile::~ArchiveFile() { commit(); }

Result<std::unique_ptr<ArchiveFile>> ArchiveFile::open(const std::string& path, std::int64_t limit_octets) {
  std::unique_ptr<ArchiveFile> file;
  try {
    file.reset(new ArchiveFile{path, limit_octets});
    const std::int64_t owner = file->number("PRAGMA application_id"), version = file->number("PRAGMA user_version");
    if (owner != 0 && owner != application_id)
      return fail(ErrorCode::Mismatch, "this is a database of something else, not an archive", owner);
    if (version != 0 && version != schema_version)
      return fail(ErrorCode::Mismatch, "the archive was written by another version of hirosco", version);
    file->database_.exec(schema);
    // Neither: a new one, or one from before they were written.
    if (owner == 0) file->database_.exec(mark);
    return file;
  } catch (const SQLite::Exception& refused) {
    if (file == nullptr) return fail(ErrorCode::Unavailable, "the archive cannot be opened", refused.getErrorCode());
    return fail(ErrorCode::Malformed, "the archive is not one of ours", refused.getExtendedErrorCode());
  }
}

std::int64_t ArchiveFile::number(const std::string& sql) {
  std::int64_t answer = 0;
  counted([&] { answer = database_.execAndGet(sql); });
  return answer;
}

void ArchiveFile::begin() {
  if (!in_transaction_) in_transaction_ = database_.tryExec("BEGIN") == SQLite::OK;
}

void ArchiveFile::commit() {
  if (!in_transaction_) return;
  if (database_.tryExec("COMMIT") != SQLite::OK) {
    ++failures_;
    // Full or busy: what waits is tried again with the next.
    if (sqlite3_get_autocommit(database_.getHandle()) == 0) return;
  }
  in_transaction_ = false;
}

void ArchiveFile::keep_within_limit() {
  commit();
  const std::int64_t used =
      (number("PRAGMA page_count") - number("PRAGMA freelist_count")) * number("PRAGMA page_size");
  if (used < limit_octets_) return;
  // Little at a time, since the live view waits; of every table the same share.
  constexpr std::int64_t most_packets = 5000;
  const auto size = [&](const std::string& table) {
    const std::int64_t oldest = number("SELECT min(id) FROM " + table);
    return std::pair{oldest, number("SELECT max(id) FROM " + table) - oldest + 1};
  };
  const std::int64_t packets = size("packets").second;
  const std::int64_t removed = std::min(most_packets, packets / 10 + 1);
  for (const char* table : {"packets", "events", "commands", "reports", "changes", "gaps", "faults", "marks"}) {
    const auto [oldest, count] = size(table);
    store("DELETE FROM " + std::string{table} + " WHERE id < ?",
          oldest + static_cast<std::int64_t>(static_cast<double>(count) * static_cast<double>(removed) /
                                             static_cast<double>(packets)));
  }
  commit();
}

}  // namespace hirosco::ground
