// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/archive/archive.hpp"

#include <sqlite3.h>

#include <algorithm>

#include "ground/archive/columns.hpp"

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

Archive::Archive(const std::string& path, std::int64_t limit_octets)
    : database_{std::make_unique<SQLite::Database>(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, busy_limit_ms)},
      limit_octets_{limit_octets} {}

Result<std::unique_ptr<Archive>> Archive::open(const std::string& path, std::int64_t limit_octets) {
  std::unique_ptr<Archive> archive;
  try {
    archive.reset(new Archive{path, limit_octets});
    const std::int64_t owner = archive->number("PRAGMA application_id"),
                       version = archive->number("PRAGMA user_version");
    if (owner != 0 && owner != application_id)
      return fail(ErrorCode::Mismatch, "this is a database of something else, not an archive", owner);
    if (version != 0 && version != schema_version)
      return fail(ErrorCode::Mismatch, "the archive was written by another version of hirosco", version);
    archive->database_->exec(schema);
    // Neither: a new one, or one from before they were written.
    if (owner == 0) archive->database_->exec(mark);
    archive->add_packet_ = std::make_unique<SQLite::Statement>(
        *archive->database_, "INSERT INTO packets(t, apid, service, subtype, sid, octets) VALUES(?, ?, ?, ?, ?, ?)");
    // From here on nobody else's business with the file holds up the live view: what it costs is counted.
    archive->database_->setBusyTimeout(0);
    return archive;
  } catch (const SQLite::Exception& refused) {
    if (archive == nullptr) return fail(ErrorCode::Unavailable, "the archive cannot be opened", refused.getErrorCode());
    return fail(ErrorCode::Malformed, "the archive is not one of ours", refused.getExtendedErrorCode());
  }
}

Archive::~Archive() { commit(); }

std::int64_t Archive::number(const std::string& sql) {
  std::int64_t answer = 0;
  counted([&] { answer = database_->execAndGet(sql); });
  return answer;
}

void Archive::begin() {
  if (!in_transaction_) in_transaction_ = database_->tryExec("BEGIN") == SQLite::OK;
}

void Archive::commit() {
  if (!in_transaction_) return;
  if (database_->tryExec("COMMIT") != SQLite::OK) {
    ++failures_;
    // Full or busy: what waits is tried again with the next.
    if (sqlite3_get_autocommit(database_->getHandle()) == 0) return;
  }
  in_transaction_ = false;
}

void Archive::keep_within_limit() {
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

template <class... Values>
bool Archive::store(const std::string& sql, const Values&... values) {
  begin();
  return counted([&] { statement(*database_, sql, values...).exec(); });
}

void Archive::add(const StoredPacket& packet, Octets octets) {
  begin();
  counted([&] {
    bind(*add_packet_, packet.t, packet.apid, packet.service, packet.subtype, packet.sid);
    add_packet_->bindNoCopy(6, octets.data(), static_cast<int>(octets.size()));
    add_packet_->exec();
  });
  static_cast<void>(add_packet_->tryReset());  // unfinished it would keep its lock
}

void Archive::add(const StoredEvent& event) {
  store("INSERT INTO events(t, apid, subsystem, event, name, severity, text, vals) VALUES(?,?,?,?,?,?,?,?)", event.t,
        event.apid, event.subsystem, event.id, event.name, event.severity, event.text, event.values);
}

std::int64_t Archive::add(const StoredCommand& command) {
  const bool added = store(
      "INSERT INTO commands(t, sender, apid, subsystem, function, arguments, stage, code, reason) "
      "VALUES(?,?,?,?,?,?,?,?,?)",
      command.t, command.sender, command.apid, command.subsystem, command.function, command.arguments, command.stage,
      command.code, command.reason);
  // The number of whatever was added last would give its reports to a stranger.
  return added ? database_->getLastInsertRowid() : 0;
}

void Archive::add(std::int64_t command, const StoredReport& report) {
  if (command == 0) return;
  if (store("INSERT INTO reports(command, t, stage, code, reason) VALUES(?,?,?,?,?)", command, report.t, report.stage,
            report.code, report.reason))
    store("UPDATE commands SET stage=?, code=?, reason=? WHERE id=?", report.stage, report.code, report.reason,
          command);
}

void Archive::add(const StoredChange& change) {
  store("INSERT INTO changes(t, kind, name, value) VALUES(?,?,?,?)", change.t, change.kind, change.name, change.value);
}

void Archive::add(const StoredGap& gap) { store("INSERT INTO gaps(t, until) VALUES(?,?)", gap.from, gap.to); }

void Archive::close_gaps(const Span& span) {
  store("DELETE FROM gaps WHERE t >= ? AND until <= ?", span.from, span.to);
}

void Archive::add(const StoredFault& fault) {
  store("INSERT INTO faults(t, device, line, answer) VALUES(?,?,?,?)", fault.t, fault.device, fault.line, fault.answer);
}

std::int64_t Archive::add(const StoredMark& mark) {
  const bool added = store("INSERT INTO marks(t, kind, name, action, who, note, until) VALUES(?,?,?,?,?,?,?)", mark.t,
                           mark.kind, mark.name, mark.action, mark.who, mark.note, mark.until);
  return added ? database_->getLastInsertRowid() : 0;
}

}  // namespace hirosco::ground
