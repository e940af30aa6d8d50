// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/archive/archive.hpp"

#include <algorithm>

#include "ground/archive/statement.hpp"

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
)";
/// Written once, so that nobody's other file is filled and no other version is misread.
constexpr const char* mark = "PRAGMA application_id = 1213417281; PRAGMA user_version = 1";
constexpr std::int64_t application_id = 1213417281;  ///< "HSGA"
constexpr std::int64_t schema_version = 1;
constexpr int busy_limit_ms = 2000;  ///< while opening

}  // namespace

Result<std::unique_ptr<Archive>> Archive::open(const std::string& path, std::int64_t limit_octets) {
  sqlite3* database = nullptr;
  const int opened = sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  if (opened != SQLITE_OK) {
    sqlite3_close(database);
    return fail(ErrorCode::Unavailable, "the archive cannot be opened", opened);
  }
  auto archive = std::unique_ptr<Archive>{new Archive{database, limit_octets}};
  sqlite3_busy_timeout(database, busy_limit_ms);
  const auto number = [&](const char* sql) {
    Statement statement{*archive, sql};
    return statement.row() ? statement.integer() : 0;
  };
  const std::int64_t owner = number("PRAGMA application_id"), version = number("PRAGMA user_version");
  if (owner != 0 && owner != application_id)
    return fail(ErrorCode::Mismatch, "this is a database of something else, not an archive", owner);
  if (version != 0 && version != schema_version)
    return fail(ErrorCode::Mismatch, "the archive was written by another version of hirosco", version);
  constexpr const char* add_packet =
      "INSERT INTO packets(t, apid, service, subtype, sid, octets) VALUES(?, ?, ?, ?, ?, ?)";
  // Neither: a new one, or one from before they were written.
  if (!archive->execute(schema) || (owner == 0 && !archive->execute(mark)) ||
      sqlite3_prepare_v2(database, add_packet, -1, &archive->add_packet_, nullptr) != SQLITE_OK)
    return fail(ErrorCode::Malformed, "the archive is not one of ours", sqlite3_extended_errcode(database));
  // From here on nobody else's business with the file holds up the live view: what it costs is counted.
  sqlite3_busy_timeout(database, 0);
  return archive;
}

Archive::~Archive() {
  commit();
  sqlite3_finalize(add_packet_);
  sqlite3_close(database_);
}

bool Archive::execute(const char* sql) { return sqlite3_exec(database_, sql, nullptr, nullptr, nullptr) == SQLITE_OK; }

void Archive::begin() {
  if (!in_transaction_) in_transaction_ = execute("BEGIN");
}

void Archive::commit() {
  if (!in_transaction_) return;
  if (!execute("COMMIT")) {
    ++failures_;
    if (sqlite3_get_autocommit(database_) == 0) return;  // full or busy: what waits is tried again with the next
  }
  in_transaction_ = false;
}

void Archive::keep_within_limit() {
  commit();
  const auto value = [this](const std::string& sql) {
    Statement statement{*this, sql};
    return statement.row() ? statement.integer() : 0;
  };
  const std::int64_t used = (value("PRAGMA page_count") - value("PRAGMA freelist_count")) * value("PRAGMA page_size");
  if (used < limit_octets_) return;
  // Little at a time, since the live view waits; of every table the same share.
  constexpr std::int64_t most_packets = 5000;
  const auto size = [&](const std::string& table) {
    const std::int64_t oldest = value("SELECT min(id) FROM " + table);
    return std::pair{oldest, value("SELECT max(id) FROM " + table) - oldest + 1};
  };
  const std::int64_t packets = size("packets").second;
  const std::int64_t removed = std::min(most_packets, packets / 10 + 1);
  begin();
  for (const char* table : {"packets", "events", "commands", "reports", "changes", "gaps", "faults"}) {
    const auto [oldest, count] = size(table);
    Statement remove{*this, "DELETE FROM " + std::string{table} + " WHERE id < ?"};
    remove << oldest + static_cast<std::int64_t>(static_cast<double>(count) * static_cast<double>(removed) /
                                                 static_cast<double>(packets));
    if (!remove.run()) ++failures_;
  }
  commit();
}

void Archive::add(const StoredPacket& packet, Octets octets) {
  begin();
  sqlite3_reset(add_packet_);
  sqlite3_bind_int64(add_packet_, 1, Statement::ns(packet.t));
  sqlite3_bind_int(add_packet_, 2, packet.apid);
  sqlite3_bind_int(add_packet_, 3, packet.service);
  sqlite3_bind_int(add_packet_, 4, packet.subtype);
  sqlite3_bind_int(add_packet_, 5, packet.sid);
  sqlite3_bind_blob(add_packet_, 6, octets.data(), static_cast<int>(octets.size()), SQLITE_STATIC);
  if (sqlite3_step(add_packet_) != SQLITE_DONE) ++failures_;
  sqlite3_reset(add_packet_);
}

void Archive::add(const StoredEvent& event) {
  begin();
  Statement add{*this,
                "INSERT INTO events(t, apid, subsystem, event, name, severity, text, vals) VALUES(?,?,?,?,?,?,?,?)"};
  add << event.t << event.apid << event.subsystem << event.id << event.name << event.severity << event.text
      << event.values;
  if (!add.run()) ++failures_;
}

std::int64_t Archive::add(const StoredCommand& command) {
  begin();
  Statement add{*this,
                "INSERT INTO commands(t, sender, apid, subsystem, function, arguments, stage, code, reason) "
                "VALUES(?,?,?,?,?,?,?,?,?)"};
  add << command.t << command.sender << command.apid << command.subsystem << command.function << command.arguments
      << command.stage << command.code << command.reason;
  if (add.run()) return sqlite3_last_insert_rowid(database_);
  // The number of whatever was added last would give its reports to a stranger.
  ++failures_;
  return 0;
}

void Archive::add(std::int64_t command, const StoredReport& report) {
  if (command == 0) return;
  begin();
  Statement add{*this, "INSERT INTO reports(command, t, stage, code, reason) VALUES(?,?,?,?,?)"};
  add << command << report.t << report.stage << report.code << report.reason;
  Statement update{*this, "UPDATE commands SET stage=?, code=?, reason=? WHERE id=?"};
  update << report.stage << report.code << report.reason << command;
  if (!add.run() || !update.run()) ++failures_;
}

void Archive::add(const StoredChange& change) {
  begin();
  Statement add{*this, "INSERT INTO changes(t, kind, name, value) VALUES(?,?,?,?)"};
  add << change.t << change.kind << change.name << change.value;
  if (!add.run()) ++failures_;
}

void Archive::add(const StoredGap& gap) {
  begin();
  Statement add{*this, "INSERT INTO gaps(t, until) VALUES(?,?)"};
  add << gap.from << gap.to;
  if (!add.run()) ++failures_;
}

void Archive::add(const StoredFault& fault) {
  begin();
  Statement add{*this, "INSERT INTO faults(t, device, line, answer) VALUES(?,?,?,?)"};
  add << fault.t << fault.device << fault.line << fault.answer;
  if (!add.run()) ++failures_;
}

}  // namespace hirosco::ground
