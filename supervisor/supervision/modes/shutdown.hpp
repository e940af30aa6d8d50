// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/telecommands.hpp"
#include "supervisor/supervision/interfaces.hpp"
#include "supervisor/supervision/modes/commissioning.hpp"
#include "supervisor/supervision/modes/sequence.hpp"

namespace hirosco::supervisor {

/// The orderly end of a flight: everybody back to Offline, the ground link last, within a time. Thread: the supervisor's.
class Shutdown final {
 public:
  Shutdown(Craft& craft, OwnSubsystem& own, CommandDesk& desk, Commissioning& commissioning)
      : craft_{craft}, own_{own}, commissioning_{commissioning}, sequence_{desk} {}

  /// SHUTDOWN, which no cycle and no queue holds up.
  void provide(Telecommands& telecommands);
  void request();
  /// Ends what is left when the time has run out.
  void enforce(TimePoint now);
  [[nodiscard]] bool finished() const noexcept { return finished_; }
  [[nodiscard]] std::string waiting_for() const { return sequence_.waiting_for(); }

 private:
  Craft& craft_;
  OwnSubsystem& own_;
  Commissioning& commissioning_;
  Sequence sequence_;
  TimePoint deadline_{};
  bool finished_{false};
};

}  // namespace hirosco::supervisor
