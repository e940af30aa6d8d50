// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <optional>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/modes/under_way.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/procedures/procedure_runner.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

class Reception;

/// The orderly end of a flight: everybody back to Offline, the ground link last, within a time. Thread: the supervisor's.
class Shutdown final {
 public:
  struct Parts {
    const Means& means;
    OwnSubsystem& own;
    UnderWay& under_way;
    Accounts& accounts;
    Reception& reception;
  };
  explicit Shutdown(const Parts& parts) : parts_{parts}, craft_{parts.means.craft}, runner_{parts.means} {}

  void provide();
  /// SHUTDOWN, carried out where it is received.
  void command(const pus::Request& asked);
  /// `by`: who asks, as the log is to say it.
  void request(std::string_view by = {});
  /// Ends what is left when the time has run out. The flight is over one step after the last member: what is said of that
  /// is in the log.
  void enforce(TimePoint now);
  [[nodiscard]] bool finished() const noexcept { return finished_; }
  [[nodiscard]] std::string waiting_for() const { return runner_.waiting_for(); }

 private:
  void end_others();
  void bring_down_ground_link();
  void end();

  Parts parts_;
  Craft& craft_;
  ProcedureRunner runner_;
  TimePoint deadline_{};
  bool others_down_{false};
  bool ended_{false};
  bool finished_{false};
};

}  // namespace hirosco::supervisor
