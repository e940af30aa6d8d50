// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "supervisor/keeper/kept.hpp"
#include "supervisor/keeper/kept_store.hpp"
#include "supervisor/platform/launch/launcher.hpp"

namespace hirosco::supervisor {

/// A launcher as a flight in real time needs it: whose members can be waited for, ended together, and may end the flight.
/// Thread: the supervisor's.
class FlightLauncher : public ProcessLauncher {
 public:
  /// Before the first launch, behind keep_with(). What it tells of that for the story of the flight; empty: nothing. Error in words: no flight.
  [[nodiscard]] virtual std::expected<std::string, std::string> begin(const descriptor::Mission& mission) = 0;
  /// From now on the keeper holds what it launches, slot by slot in the order of this mission, and adopt() finds what it held. `page`: the
  /// keeper's, which tells how those ended whose parent was a supervisor before, and whom it had no room for; null: nobody does.
  /// False: what it launches does not outlive this process, and nothing is held.
  [[nodiscard]] virtual bool keep_with(StoreClient /*store*/, const descriptor::Mission& /*mission*/,
                                       InheritedParts /*inherited*/, KeeperPage* /*page*/) {
    return false;
  }
  [[nodiscard]] bool grants_core(std::uint16_t core) noexcept override { return grants_processor(core); }
  /// Ends what still runs, as far as that is possible: nobody would be left to do it.
  virtual void kill_all() = 0;
  /// True while one that was started still runs.
  [[nodiscard]] virtual bool any_running() = 0;
  /// Readable when it has ended; -1 when unknown.
  [[nodiscard]] virtual int wait_descriptor(std::uint32_t process) = 0;
  /// Why the flight as a whole has to end, in words; empty: it may go on.
  [[nodiscard]] virtual std::optional<std::string> must_end(TimePoint /*now*/) { return std::nullopt; }
};

}  // namespace hirosco::supervisor
