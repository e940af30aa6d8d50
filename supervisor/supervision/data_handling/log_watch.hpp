// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "supervisor/supervision/data_handling/telecommands.hpp"

namespace hirosco::supervisor {

/// A log that fails, stands still or was damaged is said once, with cause and cure, and what it lost when it works again;
/// so are pieces begun and removed. Another database is taken by telecommand. Thread: the supervisor's.
class LogWatch final : public Watch {
 public:
  LogWatch(Craft& craft, OwnSubsystem& own, const Telecommands& telecommands, DatabaseOpener open_database)
      : craft_{craft}, own_{own}, telecommands_{telecommands}, open_database_{std::move(open_database)} {}

  /// SET_DATABASE.
  void provide();
  void watch(TimePoint now) override;

 private:
  void watch_trouble(TimePoint now);
  void watch_failure(TimePoint now, const LogCounters& counters);
  void watch_pieces(const StoreTurnover& turnover);

  Craft& craft_;
  OwnSubsystem& own_;
  const Telecommands& telecommands_;
  DatabaseOpener open_database_;
  bool failing_{false};
  bool news_{false};  ///< a trouble was told just now
  std::uint64_t lost_before_{0};  ///< what had no room before it failed
  StoreTurnover seen_;
  std::uint64_t told_troubles_{0};  ///< of the log's store
  TimePoint told_at_{};
};

}  // namespace hirosco::supervisor
