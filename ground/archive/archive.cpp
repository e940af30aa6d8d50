// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/archive/archive.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>

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
constexpr std::int64_t most_listed = 10'000;

[[nodiscard]] std::int64_t ns(OnboardTime t) noexcept { return t.time_since_epoch().count(); }
[[nodiscard]] OnboardTime time_of(std::int64_t value) noexcept { return OnboardTime{Duration{value}}; }

/// Text as a LIKE pattern that matches it anywhere, its own wildcards as letters.
[[nodiscard]] std::string pattern_of(std::string_view text) {
  std::string pattern = "%";
  for (const char letter : text) {
    if (letter == '%' || letter == '_' || letter == '\\') pattern += '\\';
    pattern += letter;
  }
  return pattern + "%";
}

}  // namespace

/// One prepared statement: values in, rows out.
class Archive::Statement {
 public:
  Statement(Archive& archive, const std::string& sql) : archive_{archive} {
    static_cast<void>(sqlite3_prepare_v2(archive.database_, sql.c_str(), -1, &statement_, nullptr));
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  Statement& operator<<(std::int64_t value) {
    sqlite3_bind_int64(statement_, ++bound_, value);
    return *this;
  }
  Statement& operator<<(int value) { return *this << std::int64_t{value}; }
  Statement& operator<<(OnboardTime value) { return *this << ns(value); }
  Statement& operator<<(const std::string& value) {
    sqlite3_bind_text(statement_, ++bound_, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
    return *this;
  }
  Statement& operator<<(const std::optional<int>& value) {
    if (value) return *this << *value;
    sqlite3_bind_null(statement_, ++bound_);
    return *this;
  }
  [[nodiscard]] bool row() {
    read_ = 0;
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) ++archive_.failures_;
    return result == SQLITE_ROW;
  }
  [[nodiscard]] bool run() { return sqlite3_step(statement_) == SQLITE_DONE; }

  [[nodiscard]] std::int64_t integer() { return sqlite3_column_int64(statement_, read_++); }
  [[nodiscard]] OnboardTime time() { return time_of(integer()); }
  template <class T>
  [[nodiscard]] T number() {
    return static_cast<T>(integer());
  }
  [[nodiscard]] std::optional<int> optional() {
    if (sqlite3_column_type(statement_, read_) != SQLITE_NULL) return number<int>();
    ++read_;
    return std::nullopt;
  }
  [[nodiscard]] std::string text() {
    const auto* letters = reinterpret_cast<const char*>(sqlite3_column_text(statement_, read_));
    const int size = sqlite3_column_bytes(statement_, read_++);
    return letters != nullptr ? std::string{letters, static_cast<std::size_t>(size)} : std::string{};
  }
  [[nodiscard]] std::vector<std::byte> octets() {
    const auto* first = static_cast<const std::byte*>(sqlite3_column_blob(statement_, read_));
    const int size = sqlite3_column_bytes(statement_, read_++);
    return first != nullptr ? std::vector<std::byte>{first, first + size} : std::vector<std::byte>{};
  }

 private:
  Archive& archive_;
  sqlite3_stmt* statement_{nullptr};
  int bound_{0};
  int read_{0};
};

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
  sqlite3_bind_int64(add_packet_, 1, ns(packet.t));
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

std::optional<Span> Archive::extent() {
  Statement find{*this, "SELECT min(t), max(t), count(*) FROM (SELECT t FROM packets ORDER BY t LIMIT 1)"};
  Statement last{*this, "SELECT max(t) FROM packets"};
  if (!find.row() || !last.row()) return std::nullopt;
  Span span;
  span.from = find.time();
  static_cast<void>(find.time());
  if (find.integer() == 0) return std::nullopt;
  span.to = last.time();
  return span;
}

void Archive::packets(const Span& span, const std::function<bool(const StoredPacket&)>& take) {
  Statement find{*this,
                 "SELECT t, apid, service, subtype, sid, octets FROM packets WHERE t >= ? AND t <= ? ORDER BY t, id"};
  find << span.from << span.to;
  while (find.row()) {
    StoredPacket packet{.t = find.time(), .octets = {}};
    packet.apid = find.number<std::uint16_t>();
    packet.service = find.number<std::uint8_t>();
    packet.subtype = find.number<std::uint8_t>();
    packet.sid = find.number<std::uint16_t>();
    packet.octets = find.octets();
    if (!take(packet)) return;
  }
}

void Archive::packets_back(OnboardTime to, std::int64_t before, Housekeeping housekeeping,
                           const std::function<bool(const StoredPacket&)>& take) {
  OnboardTime from = to;
  std::int64_t number = std::numeric_limits<std::int64_t>::max();
  if (before != 0) {
    Statement find{*this, "SELECT t FROM packets WHERE id = ?"};
    find << before;
    if (!find.row()) return;
    from = find.time();
    number = before;
  }
  const std::string which = housekeeping == Housekeeping::LeftOut ? "sid = 0 AND " : "";
  Statement find{*this, "SELECT id, t, apid, service, subtype, octets FROM packets WHERE " + which +
                            "t <= ? AND (t, id) < (?, ?) ORDER BY t DESC, id DESC"};
  find << from << from << number;
  while (find.row()) {
    StoredPacket packet{.number = find.integer(), .t = find.time(), .octets = {}};
    packet.apid = find.number<std::uint16_t>();
    packet.service = find.number<std::uint8_t>();
    packet.subtype = find.number<std::uint8_t>();
    packet.octets = find.octets();
    if (!take(packet)) return;
  }
}

void Archive::packets_of(std::uint16_t apid, std::uint16_t sid, const Span& span,
                         const std::function<bool(const StoredPacket&)>& take) {
  Statement find{*this,
                 "SELECT t, octets FROM packets WHERE apid = ? AND sid = ? AND sid != 0 AND t >= ? AND t <= ? "
                 "ORDER BY t"};
  find << apid << sid << span.from << span.to;
  StoredPacket packet{.apid = apid, .service = 3, .subtype = 25, .sid = sid, .octets = {}};
  while (find.row()) {
    packet.t = find.time();
    packet.octets = find.octets();
    if (!take(packet)) return;
  }
}

std::optional<StoredPacket> Archive::last_of(std::uint16_t apid, std::uint16_t sid, OnboardTime before) {
  Statement find{*this,
                 "SELECT t, octets FROM packets WHERE apid = ? AND sid = ? AND sid != 0 AND t <= ? "
                 "ORDER BY t DESC LIMIT 1"};
  find << apid << sid << before;
  if (!find.row()) return std::nullopt;
  StoredPacket packet{.apid = apid, .service = 3, .subtype = 25, .sid = sid, .octets = {}};
  packet.t = find.time();
  packet.octets = find.octets();
  return packet;
}

std::vector<StoredEvent> Archive::events(const Filter& filter) {
  const char* sql = filter.newest_first
                        ? "SELECT t, apid, subsystem, event, name, severity, text, vals FROM events WHERE t >= ? AND "
                          "t <= ? AND severity >= ? AND (subsystem || ' ' || name || ' ' || text) LIKE ? ESCAPE '\\' "
                          "ORDER BY t DESC, id DESC LIMIT ?"
                        : "SELECT t, apid, subsystem, event, name, severity, text, vals FROM events WHERE t >= ? AND "
                          "t <= ? AND severity >= ? AND (subsystem || ' ' || name || ' ' || text) LIKE ? ESCAPE '\\' "
                          "ORDER BY t, id LIMIT ?";
  Statement find{*this, sql};
  find << filter.span.from << filter.span.to << filter.severity << pattern_of(filter.text)
       << static_cast<std::int64_t>(filter.limit);
  std::vector<StoredEvent> events;
  while (find.row()) {
    StoredEvent event;
    event.t = find.time();
    event.apid = find.number<std::uint16_t>();
    event.subsystem = find.text();
    event.id = find.number<std::uint16_t>();
    event.name = find.text();
    event.severity = find.number<int>();
    event.text = find.text();
    event.values = find.text();
    events.push_back(std::move(event));
  }
  return events;
}

namespace {

template <class Row>
[[nodiscard]] StoredCommand command_of(Row& row) {
  StoredCommand command;
  command.number = row.integer();
  command.t = row.time();
  command.sender = row.text();
  command.apid = row.template number<std::uint16_t>();
  command.subsystem = row.text();
  command.function = row.text();
  command.arguments = row.text();
  command.stage = row.text();
  command.code = row.optional();
  command.reason = row.text();
  return command;
}

}  // namespace

std::vector<StoredCommand> Archive::commands(const Filter& filter) {
  const char* sql = filter.newest_first
                        ? "SELECT id, t, sender, apid, subsystem, function, arguments, stage, code, reason FROM "
                          "commands WHERE t >= ? AND t <= ? AND (subsystem || ' ' || function || ' ' || sender) LIKE ? "
                          "ESCAPE '\\' ORDER BY t DESC, id DESC LIMIT ?"
                        : "SELECT id, t, sender, apid, subsystem, function, arguments, stage, code, reason FROM "
                          "commands WHERE t >= ? AND t <= ? AND (subsystem || ' ' || function || ' ' || sender) LIKE ? "
                          "ESCAPE '\\' ORDER BY t, id LIMIT ?";
  Statement find{*this, sql};
  find << filter.span.from << filter.span.to << pattern_of(filter.text) << static_cast<std::int64_t>(filter.limit);
  std::vector<StoredCommand> commands;
  while (find.row()) commands.push_back(command_of(find));
  return commands;
}

std::optional<StoredCommand> Archive::command(std::int64_t number) {
  Statement find{*this,
                 "SELECT id, t, sender, apid, subsystem, function, arguments, stage, code, reason FROM commands "
                 "WHERE id = ?"};
  find << number;
  if (!find.row()) return std::nullopt;
  return command_of(find);
}

std::vector<StoredReport> Archive::reports(std::int64_t command) {
  Statement find{*this, "SELECT t, stage, code, reason FROM reports WHERE command = ? ORDER BY id"};
  find << command;
  std::vector<StoredReport> reports;
  while (find.row()) {
    StoredReport report{.t = find.time(), .stage = find.text(), .code = find.optional(), .reason = {}};
    report.reason = find.text();
    reports.push_back(std::move(report));
  }
  return reports;
}

std::vector<std::pair<std::int64_t, StoredReport>> Archive::reports_in(const Span& span) {
  Statement find{*this, "SELECT command, t, stage, code, reason FROM reports WHERE t >= ? AND t <= ? ORDER BY t, id"};
  find << span.from << span.to;
  std::vector<std::pair<std::int64_t, StoredReport>> reports;
  while (find.row()) {
    const std::int64_t command = find.integer();
    StoredReport report{.t = find.time(), .stage = find.text(), .code = find.optional(), .reason = {}};
    report.reason = find.text();
    reports.emplace_back(command, std::move(report));
  }
  return reports;
}

std::vector<StoredChange> Archive::changes(Span span) {
  const auto rows = [](Statement& find) {
    std::vector<StoredChange> changes;
    while (find.row()) {
      StoredChange change{.t = find.time(), .kind = find.text(), .name = find.text(), .value = {}};
      change.value = find.text();
      changes.push_back(std::move(change));
    }
    return changes;
  };
  Statement newest{*this,
                   "SELECT t, kind, name, value FROM (SELECT id, t, kind, name, value FROM changes WHERE t >= ? AND "
                   "t <= ? ORDER BY t DESC, id DESC LIMIT ?) ORDER BY t, id"};
  newest << span.from << span.to << most_listed;
  const auto within = rows(newest);
  // Too many: the story begins later, with what held then.
  if (std::ssize(within) == most_listed) span.from = within.front().t;
  // SQLite takes the other columns from the row that has the greatest time.
  Statement before{*this, "SELECT max(t), kind, name, value FROM changes WHERE t < ? GROUP BY kind, name"};
  before << span.from;
  auto changes = rows(before);
  for (StoredChange& change : changes) change.t = span.from;
  changes.insert(changes.end(), within.begin(), within.end());
  return changes;
}

std::vector<StoredGap> Archive::gaps(const Span& span) {
  Statement find{*this,
                 "SELECT t, until FROM (SELECT t, until FROM gaps WHERE until >= ? AND t <= ? ORDER BY t DESC LIMIT ?) "
                 "ORDER BY t"};
  find << span.from << span.to << most_listed;
  std::vector<StoredGap> gaps;
  while (find.row()) {
    StoredGap gap{.from = find.time()};
    gap.to = find.time();
    gaps.push_back(gap);
  }
  return gaps;
}

std::vector<StoredFault> Archive::faults(const Span& span) {
  Statement find{*this,
                 "SELECT t, device, line, answer FROM (SELECT t, device, line, answer FROM faults WHERE t >= ? AND "
                 "t <= ? ORDER BY t DESC LIMIT ?) ORDER BY t"};
  find << span.from << span.to << most_listed;
  std::vector<StoredFault> faults;
  while (find.row()) {
    StoredFault fault{.t = find.time(), .device = find.text(), .line = find.text(), .answer = {}};
    fault.answer = find.text();
    faults.push_back(std::move(fault));
  }
  return faults;
}

}  // namespace hirosco::ground
