// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>

#include "ground/archive/archive.hpp"
#include "ground/archive/archive_file.hpp"

/// What the archive is asked.
namespace hirosco::ground {
namespace {

constexpr std::int64_t most_listed = 10'000;

/// Text as a LIKE pattern that matches it anywhere, its own wildcards as letters.
[[nodiscard]] std::string pattern_of(std::string_view text) {
  std::string pattern = "%";
  for (const char letter : text) {
    if (letter == '%' || letter == '_' || letter == '\\') pattern += '\\';
    pattern += letter;
  }
  return pattern + "%";
}

[[nodiscard]] StoredEvent event_of(const SQLite::Statement& row) {
  return {.t = time_of(row.getColumn(0)),
          .apid = row.getColumn(1),
          .subsystem = row.getColumn(2),
          .id = row.getColumn(3),
          .name = row.getColumn(4),
          .severity = row.getColumn(5),
          .text = row.getColumn(6),
          .values = row.getColumn(7)};
}

[[nodiscard]] StoredCommand command_of(const SQLite::Statement& row) {
  return {.number = row.getColumn(0),
          .t = time_of(row.getColumn(1)),
          .sender = row.getColumn(2),
          .apid = row.getColumn(3),
          .subsystem = row.getColumn(4),
          .function = row.getColumn(5),
          .arguments = row.getColumn(6),
          .stage = row.getColumn(7),
          .code = optional_of(row.getColumn(8)),
          .reason = row.getColumn(9)};
}

/// From the column of its time on.
[[nodiscard]] StoredReport report_from(const SQLite::Statement& row, int first) {
  return {.t = time_of(row.getColumn(first)),
          .stage = row.getColumn(first + 1),
          .code = optional_of(row.getColumn(first + 2)),
          .reason = row.getColumn(first + 3)};
}
[[nodiscard]] StoredReport report_of(const SQLite::Statement& row) { return report_from(row, 0); }
[[nodiscard]] std::pair<std::int64_t, StoredReport> numbered_report_of(const SQLite::Statement& row) {
  return {row.getColumn(0).getInt64(), report_from(row, 1)};
}

[[nodiscard]] StoredChange change_of(const SQLite::Statement& row) {
  return {
      .t = time_of(row.getColumn(0)), .kind = row.getColumn(1), .name = row.getColumn(2), .value = row.getColumn(3)};
}

[[nodiscard]] StoredGap gap_of(const SQLite::Statement& row) {
  return {.from = time_of(row.getColumn(0)), .to = time_of(row.getColumn(1))};
}

[[nodiscard]] StoredFault fault_of(const SQLite::Statement& row) {
  return {
      .t = time_of(row.getColumn(0)), .device = row.getColumn(1), .line = row.getColumn(2), .answer = row.getColumn(3)};
}

[[nodiscard]] StoredMark mark_of(const SQLite::Statement& row) {
  return {.t = time_of(row.getColumn(0)),
          .kind = row.getColumn(1),
          .name = row.getColumn(2),
          .action = row.getColumn(3),
          .who = row.getColumn(4),
          .note = row.getColumn(5),
          .until = time_of(row.getColumn(6))};
}

[[nodiscard]] std::int64_t number_of(const SQLite::Statement& row) { return row.getColumn(0).getInt64(); }

}  // namespace

std::optional<Span> Archive::extent() {
  std::optional<Span> extent;
  file_->counted([&] {
    auto first = statement(file_->database(), "SELECT t FROM packets ORDER BY t LIMIT 1");
    auto last = statement(file_->database(), "SELECT max(t) FROM packets");
    if (first.executeStep() && last.executeStep())
      extent = Span{.from = time_of(first.getColumn(0)), .to = time_of(last.getColumn(0))};
  });
  return extent;
}

void Archive::packets(const Span& span, const std::function<bool(const StoredPacket&)>& take) {
  StoredPacket packet;
  const auto read = [&](const SQLite::Statement& row) {
    packet.t = time_of(row.getColumn(0));
    packet.apid = row.getColumn(1);
    packet.service = row.getColumn(2);
    packet.subtype = row.getColumn(3);
    packet.sid = row.getColumn(4);
    read_octets(packet, row.getColumn(5));
    return take(packet);
  };
  file_->each(read, "SELECT t, apid, service, subtype, sid, octets FROM packets WHERE t >= ? AND t <= ? ORDER BY t, id",
              span.from, span.to);
}

void Archive::packets_back(OnboardTime to, std::int64_t before, Housekeeping housekeeping,
                           const std::function<bool(const StoredPacket&)>& take) {
  file_->counted([&] {
    OnboardTime from = to;
    std::int64_t number = std::numeric_limits<std::int64_t>::max();
    if (before != 0) {
      auto find = statement(file_->database(), "SELECT t FROM packets WHERE id = ?", before);
      if (!find.executeStep()) return;
      from = time_of(find.getColumn(0));
      number = before;
    }
    const std::string which = housekeeping == Housekeeping::LeftOut ? "sid = 0 AND " : "";
    auto find = statement(file_->database(),
                          "SELECT id, t, apid, service, subtype, octets FROM packets WHERE " + which +
                              "t <= ? AND (t, id) < (?, ?) ORDER BY t DESC, id DESC",
                          from, from, number);
    StoredPacket packet;
    while (find.executeStep()) {
      packet.number = find.getColumn(0);
      packet.t = time_of(find.getColumn(1));
      packet.apid = find.getColumn(2);
      packet.service = find.getColumn(3);
      packet.subtype = find.getColumn(4);
      read_octets(packet, find.getColumn(5));
      if (!take(packet)) return;
    }
  });
}

void Archive::packets_of(std::uint16_t apid, std::uint16_t sid, const Span& span,
                         const std::function<bool(const StoredPacket&)>& take) {
  StoredPacket packet{.apid = apid, .service = 3, .subtype = 25, .sid = sid, .octets = {}};
  const auto read = [&](const SQLite::Statement& row) {
    packet.t = time_of(row.getColumn(0));
    read_octets(packet, row.getColumn(1));
    return take(packet);
  };
  file_->each(read,
              "SELECT t, octets FROM packets WHERE apid = ? AND sid = ? AND sid != 0 AND t >= ? AND "
              "t <= ? ORDER BY t",
              apid, sid, span.from, span.to);
}

std::optional<StoredPacket> Archive::last_of(std::uint16_t apid, std::uint16_t sid, OnboardTime before) {
  std::optional<StoredPacket> last;
  file_->counted([&] {
    auto find = statement(file_->database(),
                          "SELECT t, octets FROM packets WHERE apid = ? AND sid = ? AND sid != 0 AND t <= ? "
                          "ORDER BY t DESC LIMIT 1",
                          apid, sid, before);
    if (!find.executeStep()) return;
    last = StoredPacket{
        .t = time_of(find.getColumn(0)), .apid = apid, .service = 3, .subtype = 25, .sid = sid, .octets = {}};
    read_octets(*last, find.getColumn(1));
  });
  return last;
}

std::vector<StoredEvent> Archive::events(const Filter& filter) {
  const char* sql = filter.newest_first
                        ? "SELECT t, apid, subsystem, event, name, severity, text, vals FROM events WHERE t >= ? AND "
                          "t <= ? AND severity >= ? AND (subsystem || ' ' || name || ' ' || text) LIKE ? ESCAPE '\\' "
                          "ORDER BY t DESC, id DESC LIMIT ?"
                        : "SELECT t, apid, subsystem, event, name, severity, text, vals FROM events WHERE t >= ? AND "
                          "t <= ? AND severity >= ? AND (subsystem || ' ' || name || ' ' || text) LIKE ? ESCAPE '\\' "
                          "ORDER BY t, id LIMIT ?";
  return file_->all(event_of, sql, filter.span.from, filter.span.to, filter.severity, pattern_of(filter.text),
                    static_cast<std::int64_t>(filter.limit));
}

std::int64_t Archive::count_events(const Span& span, int severity) {
  const char* sql = "SELECT count(*) FROM events WHERE t >= ? AND t <= ? AND severity >= ?";
  return file_->first(number_of, sql, span.from, span.to, severity).value_or(0);
}

std::int64_t Archive::count_commands(const Span& span) {
  const char* sql = "SELECT count(*) FROM commands WHERE t >= ? AND t <= ?";
  return file_->first(number_of, sql, span.from, span.to).value_or(0);
}

std::vector<StoredCommand> Archive::commands(const Filter& filter) {
  const char* sql = filter.newest_first
                        ? "SELECT id, t, sender, apid, subsystem, function, arguments, stage, code, reason FROM "
                          "commands WHERE t >= ? AND t <= ? AND (subsystem || ' ' || function || ' ' || sender) LIKE ? "
                          "ESCAPE '\\' ORDER BY t DESC, id DESC LIMIT ?"
                        : "SELECT id, t, sender, apid, subsystem, function, arguments, stage, code, reason FROM "
                          "commands WHERE t >= ? AND t <= ? AND (subsystem || ' ' || function || ' ' || sender) LIKE ? "
                          "ESCAPE '\\' ORDER BY t, id LIMIT ?";
  return file_->all(command_of, sql, filter.span.from, filter.span.to, pattern_of(filter.text),
                    static_cast<std::int64_t>(filter.limit));
}

std::optional<StoredCommand> Archive::command(std::int64_t number) {
  return file_->first(command_of,
                      "SELECT id, t, sender, apid, subsystem, function, arguments, stage, code, reason FROM "
                      "commands WHERE id = ?",
                      number);
}

std::vector<StoredReport> Archive::reports(std::int64_t command) {
  return file_->all(report_of, "SELECT t, stage, code, reason FROM reports WHERE command = ? ORDER BY id", command);
}

std::vector<std::pair<std::int64_t, StoredReport>> Archive::reports_in(const Span& span) {
  return file_->all(numbered_report_of,
                    "SELECT command, t, stage, code, reason FROM reports WHERE t >= ? AND t <= ? ORDER BY t, id",
                    span.from, span.to);
}

std::vector<StoredChange> Archive::changes(Span span) {
  const auto within =
      file_->all(change_of,
                 "SELECT t, kind, name, value FROM (SELECT id, t, kind, name, value FROM changes WHERE t >= ? AND "
                 "t <= ? ORDER BY t DESC, id DESC LIMIT ?) ORDER BY t, id",
                 span.from, span.to, most_listed);
  // Too many: the story begins later, with what held then.
  if (std::ssize(within) == most_listed) span.from = within.front().t;
  // SQLite takes the other columns from the row that has the greatest time.
  auto changes =
      file_->all(change_of, "SELECT max(t), kind, name, value FROM changes WHERE t < ? GROUP BY kind, name", span.from);
  for (StoredChange& change : changes) change.t = span.from;
  changes.insert(changes.end(), within.begin(), within.end());
  return changes;
}

std::vector<StoredGap> Archive::gaps(const Span& span) {
  return file_->all(gap_of,
                    "SELECT t, until FROM (SELECT t, until FROM gaps WHERE until >= ? AND t <= ? ORDER BY t "
                    "DESC LIMIT ?) ORDER BY t",
                    span.from, span.to, most_listed);
}

std::vector<StoredFault> Archive::faults(const Span& span) {
  return file_->all(fault_of,
                    "SELECT t, device, line, answer FROM (SELECT t, device, line, answer FROM faults WHERE "
                    "t >= ? AND t <= ? ORDER BY t DESC LIMIT ?) ORDER BY t",
                    span.from, span.to, most_listed);
}

std::vector<StoredMark> Archive::marks(const std::string& kind, const Span& span, std::size_t limit) {
  return file_->all(mark_of,
                    "SELECT t, kind, name, action, who, note, until FROM (SELECT * FROM marks WHERE t >= ? AND "
                    "t <= ? AND (? = '' OR kind = ?) ORDER BY id DESC LIMIT ?) ORDER BY id",
                    span.from, span.to, kind, kind, static_cast<std::int64_t>(limit));
}

}  // namespace hirosco::ground
