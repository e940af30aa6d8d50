// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/log_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace hirosco::supervisor {

namespace {
constexpr Duration patience = 1s;
}

void LogWatch::provide() {
  own_.on_function("SET_DATABASE", [this](double strategy) -> Outcome {
    auto database = open_database_(static_cast<DatabaseStrategy>(strategy));
    if (!database) {
      craft_.tell("log stays where it is: the mission names no server for that, or what reaches it is not installed");
      return refused(pus::FailureCode::ExecutionError);
    }
    craft_.tell("log switched to " + std::string{database->strategy()});
    craft_.log.switch_to(std::move(database));
    return ok();
  });
}

void LogWatch::watch(TimePoint now) {
  watch_trouble(now);
  const LogCounters counters = craft_.log.counters();
  watch_failure(now, counters);
  watch_pieces(counters.turnover);
}

void LogWatch::watch_trouble(TimePoint now) {
  const StoreTrouble trouble = craft_.log.trouble();
  // Somebody who deletes the log in a loop does not fill the console: the text carries the count.
  news_ = trouble.count != told_troubles_ && (told_troubles_ == 0 || now - told_at_ >= patience);
  if (!news_) return;
  told_troubles_ = trouble.count;
  told_at_ = now;
  craft_.tell(trouble.text, supervisor_apid);
  own_.announce(trouble.fault == StoreFault::Damaged ? "LOG_DAMAGED" : "LOG_STORE",
                {static_cast<double>(std::min<std::uint64_t>(trouble.lost, UINT32_MAX))});
}

void LogWatch::watch_failure(TimePoint now, const LogCounters& counters) {
  const auto waiting_since = telecommands_.waiting_since();
  const bool failing = craft_.log.failure().has_value() || (waiting_since && now - *waiting_since > patience);
  const std::uint64_t lost = counters.lost + counters.refused;
  if (failing && !failing_) {
    craft_.tell("log storage fails: telecommands that must be durable are held back", supervisor_apid);
    if (!news_) own_.announce("LOG_STORE", {0});
  }
  if (!failing && failing_) {
    const std::uint64_t meanwhile = std::min<std::uint64_t>(lost - lost_before_, UINT32_MAX);
    craft_.tell(fmt::format("log storage works: {} records had no room meanwhile", meanwhile), supervisor_apid);
    own_.announce("LOG_RESUMED", {static_cast<double>(meanwhile)});
  }
  if (!failing) lost_before_ = lost;
  failing_ = failing;
}

/// What is removed is removed as the mission declares, and never silently.
void LogWatch::watch_pieces(const StoreTurnover& turnover) {
  if (turnover.begun != seen_.begun) own_.announce("LOG_ROTATED", {static_cast<double>(turnover.begun - seen_.begun)});
  if (turnover.removed_pieces != seen_.removed_pieces) {
    const std::uint64_t pieces = turnover.removed_pieces - seen_.removed_pieces;
    const std::uint64_t records = turnover.removed_records - seen_.removed_records;
    craft_.tell(
        fmt::format("log: {} oldest piece{} removed as keep_MB says, up to {}, {} octets, {} records of this flight",
                    pieces, pieces == 1 ? "" : "s", turnover.newest_removed,
                    turnover.removed_octets - seen_.removed_octets, records),
        supervisor_apid);
    own_.announce("LOG_REMOVED", {static_cast<double>(pieces), static_cast<double>(records)});
  }
  seen_ = turnover;
}

}  // namespace hirosco::supervisor
