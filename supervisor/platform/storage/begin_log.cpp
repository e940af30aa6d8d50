// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/begin_log.hpp"

#include <algorithm>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "supervisor/platform/storage/log_pieces.hpp"

namespace hirosco::supervisor {

void begin_log(ThreadedPacketLog& log) {
  static_cast<void>(log.append({.kind = LogKind::Action,
                                .source = pus::supervisor_apid,
                                .peer = pus::supervisor_apid,
                                .packet = {},
                                .note = "log begins"}));
}

std::optional<std::string> why_not_begun(ThreadedPacketLog& log, const Clock& clock, Duration limit) {
  const TimePoint end = clock.now() + limit;
  for (;;) {
    // A store in trouble fails the wait at once, and heals by itself if it can.
    if (log.flush(end - clock.now())) return std::nullopt;
    if (clock.now() >= end) break;
    sleep_until(clock.now() + 20ms);
  }
  const StoreTrouble trouble = log.trouble();
  return trouble.present ? trouble.text : "the disk of the log does not answer";
}

std::optional<LogResumption> resumption_in(Database& database, LogResumption noted, std::uint64_t tail_octets) {
  const auto page = database.read({.since = noted.durable, .run = noted.run, .last = 1, .tail_octets = tail_octets});
  if (!page && page.error().code == ErrorCode::Unavailable) return std::nullopt;
  if (page && !page->records.empty()) {
    const LogRecord& record = page->records.back();
    noted.durable = std::max(noted.durable, record.number + (record.lost > 0 ? record.lost - 1 : 0));
  }
  noted.last = std::max(noted.last, noted.durable);
  return noted;
}

LogResumption resumption_of(const std::filesystem::path& log, LogResumption noted) {
  const auto pieces = pieces_of(log);
  constexpr std::size_t newest = 2;
  constexpr std::uint64_t newest_octets = std::uint64_t{1} << 20;  // its last record, and some that are damaged
  for (std::size_t i = pieces.size(); i > 0 && pieces.size() - i < newest; --i) {
    auto opened = open_database(pieces[i - 1].strategy, pieces[i - 1].path, DatabaseAccess::Read);
    if (opened) noted = resumption_in(**opened, noted, newest_octets).value_or(noted);
  }
  noted.last = std::max(noted.last, noted.durable);
  return noted;
}

}  // namespace hirosco::supervisor
