// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>

#include "ground/archive/columns.hpp"

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
[[nodiscard]] StoredReport report_of(const SQLite::Statement& row, int first) {
  return {.t = time_of(row.getColumn(first)),
          .stage = row.getColumn(first + 1),
          .code = optional_of(row.getColumn(first + 2)),
          .reason = row.getColumn(first + 3)};
}

}  // namespace

std::optional<Span> Archive::extent() {
  std::optional<Span> extent;
  counted([&] {
    auto first = statement(*database_, "SELECT t FROM packets ORDER BY t LIMIT 1");
    auto last = statement(*database_, "SELECT max(t) FROM packets");
    if (first.executeStep() && last.executeStep())
      extent = Span{.from = time_of(first.getColumn(0)), .to = time_of(last.getColumn(0))};
  });
  return extent;
}

void Archive::packets(const Span& span, const std::function<bool(const StoredPacket&)>& take) {
  counted([&] {
    auto find = statement(
        *database_, "SELECT t, apid, service, subtype, sid, octets FROM packets WHERE t >= ? AND t <= ? ORDER BY t, id",
        span.from, span.to);
    StoredPacket packet;
    while (find.executeStep()) {
      packet.t = time_of(find.getColumn(0));
      packet.apid = find.getColumn(1);
      packet.service = find.getColumn(2);
      packet.subtype = find.getColumn(3);
      packet.sid = find.getColumn(4);
      read_octets(packet, find.getColumn(5));
      if (!take(packet)) return;
    }
  });
}

void Archive::packets_back(OnboardTime to, std::int64_t before, Housekeeping housekeeping,
                           const std::function<bool(const StoredPacket&)>& take) {
  counted([&] {
    OnboardTime from = to;
    std::int64_t number = std::numeric_limits<std::int64_t>::max();
    if (before != 0) {
      auto find = statement(*database_, "SELECT t FROM packets WHERE id = ?", before);
      if (!find.executeStep()) return;
      from = time_of(find.getColumn(0));
      number = before;
    }
    const std::string which = housekeeping == Housekeeping::LeftOut ? "sid = 0 AND " : "";
    auto find = statement(*database_,
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
  counted([&] {
    auto find = statement(*database_,
                          "SELECT t, octets FROM packets WHERE apid = ? AND sid = ? AND sid != 0 AND t >= ? AND "
                          "t <= ? ORDER BY t",
                          apid, sid, span.from, span.to);
    StoredPacket packet{.apid = apid, .service = 3, .subtype = 25, .sid = sid, .octets = {}};
    while (find.executeStep()) {
      packet.t = time_of(find.getColumn(0));
      read_octets(packet, find.getColumn(1));
      if (!take(packet)) return;
    }
  });
}

std::optional<StoredPacket> Archive::last_of(std::uint16_t apid, std::uint16_t sid, OnboardTime before) {
  std::optional<StoredPacket> last;
  counted([&] {
    auto find = statement(*database_,
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
  std::vector<StoredEvent> events;
  counted([&] {
    auto find = statement(*database_, sql, filter.span.from, filter.span.to, filter.severity, pattern_of(filter.text),
                          static_cast<std::int64_t>(filter.limit));
    while (find.executeStep())
      events.push_back({.t = time_of(find.getColumn(0)),
                        .apid = find.getColumn(1),
                        .subsystem = find.getColumn(2),
                        .id = find.getColumn(3),
                        .name = find.getColumn(4),
                        .severity = find.getColumn(5),
                        .text = find.getColumn(6),
                        .values = find.getColumn(7)});
  });
  return events;
}

std::int64_t Archive::count_events(const Span& span, int severity) {
  std::int64_t count = 0;
  counted([&] {
    auto find = statement(*database_, "SELECT count(*) FROM events WHERE t >= ? AND t <= ? AND severity >= ?",
                          span.from, span.to, severity);
    if (find.executeStep()) count = find.getColumn(0).getInt64();
  });
  return count;
}

std::int64_t Archive::count_commands(const Span& span) {
  std::int64_t count = 0;
  counted([&] {
    auto find = statement(*database_, "SELECT count(*) FROM commands WHERE t >= ? AND t <= ?", span.from, span.to);
    if (find.executeStep()) count = find.getColumn(0).getInt64();
  });
  return count;
}

std::vector<StoredCommand> Archive::commands(const Filter& filter) {
  const char* sql = filter.newest_first
                        ? "SELECT id, t, sender, apid, subsystem, function, arguments, stage, code, reason FROM "
                          "commands WHERE t >= ? AND t <= ? AND (subsystem || ' ' || function || ' ' || sender) LIKE ? "
                          "ESCAPE '\\' ORDER BY t DESC, id DESC LIMIT ?"
                        : "SELECT id, t, sender, apid, subsystem, function, arguments, stage, code, reason FROM "
                          "commands WHERE t >= ? AND t <= ? AND (subsystem || ' ' || function || ' ' || sender) LIKE ? "
                          "ESCAPE '\\' ORDER BY t, id LIMIT ?";
  std::vector<StoredCommand> commands;
  counted([&] {
    auto find = statement(*database_, sql, filter.span.from, filter.span.to, pattern_of(filter.text),
                          static_cast<std::int64_t>(filter.limit));
    while (find.executeStep()) commands.push_back(command_of(find));
  });
  return commands;
}

std::optional<StoredCommand> Archive::command(std::int64_t number) {
  std::optional<StoredCommand> command;
  counted([&] {
    auto find = statement(*database_,
                          "SELECT id, t, sender, apid, subsystem, function, arguments, stage, code, reason FROM "
                          "commands WHERE id = ?",
                          number);
    if (find.executeStep()) command = command_of(find);
  });
  return command;
}

std::vector<StoredReport> Archive::reports(std::int64_t command) {
  std::vector<StoredReport> reports;
  counted([&] {
    auto find =
        statement(*database_, "SELECT t, stage, code, reason FROM reports WHERE command = ? ORDER BY id", command);
    while (find.executeStep()) reports.push_back(report_of(find, 0));
  });
  return reports;
}

std::vector<std::pair<std::int64_t, StoredReport>> Archive::reports_in(const Span& span) {
  std::vector<std::pair<std::int64_t, StoredReport>> reports;
  counted([&] {
    auto find = statement(*database_,
                          "SELECT command, t, stage, code, reason FROM reports WHERE t >= ? AND t <= ? ORDER BY t, id",
                          span.from, span.to);
    while (find.executeStep()) reports.emplace_back(find.getColumn(0).getInt64(), report_of(find, 1));
  });
  return reports;
}

std::vector<StoredChange> Archive::changes(Span span) {
  const auto rows = [this](const auto&... question) {
    std::vector<StoredChange> changes;
    counted([&] {
      auto find = statement(*database_, question...);
      while (find.executeStep())
        changes.push_back({.t = time_of(find.getColumn(0)),
                           .kind = find.getColumn(1),
                           .name = find.getColumn(2),
                           .value = find.getColumn(3)});
    });
    return changes;
  };
  const auto within = rows(
      "SELECT t, kind, name, value FROM (SELECT id, t, kind, name, value FROM changes WHERE t >= ? AND "
      "t <= ? ORDER BY t DESC, id DESC LIMIT ?) ORDER BY t, id",
      span.from, span.to, most_listed);
  // Too many: the story begins later, with what held then.
  if (std::ssize(within) == most_listed) span.from = within.front().t;
  // SQLite takes the other columns from the row that has the greatest time.
  auto changes = rows("SELECT max(t), kind, name, value FROM changes WHERE t < ? GROUP BY kind, name", span.from);
  for (StoredChange& change : changes) change.t = span.from;
  changes.insert(changes.end(), within.begin(), within.end());
  return changes;
}

std::vector<StoredGap> Archive::gaps(const Span& span) {
  std::vector<StoredGap> gaps;
  counted([&] {
    auto find = statement(*database_,
                          "SELECT t, until FROM (SELECT t, until FROM gaps WHERE until >= ? AND t <= ? ORDER BY t "
                          "DESC LIMIT ?) ORDER BY t",
                          span.from, span.to, most_listed);
    while (find.executeStep()) gaps.push_back({.from = time_of(find.getColumn(0)), .to = time_of(find.getColumn(1))});
  });
  return gaps;
}

std::vector<StoredFault> Archive::faults(const Span& span) {
  std::vector<StoredFault> faults;
  counted([&] {
    auto find = statement(*database_,
                          "SELECT t, device, line, answer FROM (SELECT t, device, line, answer FROM faults WHERE "
                          "t >= ? AND t <= ? ORDER BY t DESC LIMIT ?) ORDER BY t",
                          span.from, span.to, most_listed);
    while (find.executeStep())
      faults.push_back({.t = time_of(find.getColumn(0)),
                        .device = find.getColumn(1),
                        .line = find.getColumn(2),
                        .answer = find.getColumn(3)});
  });
  return faults;
}

std::vector<StoredMark> Archive::marks(const std::string& kind, const Span& span, std::size_t limit) {
  std::vector<StoredMark> marks;
  counted([&] {
    auto find = statement(*database_,
                          "SELECT t, kind, name, action, who, note, until FROM (SELECT * FROM marks WHERE t >= ? AND "
                          "t <= ? AND (? = '' OR kind = ?) ORDER BY id DESC LIMIT ?) ORDER BY id",
                          span.from, span.to, kind, kind, static_cast<std::int64_t>(limit));
    while (find.executeStep())
      marks.push_back({.t = time_of(find.getColumn(0)),
                       .kind = find.getColumn(1),
                       .name = find.getColumn(2),
                       .action = find.getColumn(3),
                       .who = find.getColumn(4),
                       .note = find.getColumn(5),
                       .until = time_of(find.getColumn(6))});
  });
  return marks;
}

}  // namespace hirosco::ground
