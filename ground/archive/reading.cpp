// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>

#include "ground/archive/statement.hpp"

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
