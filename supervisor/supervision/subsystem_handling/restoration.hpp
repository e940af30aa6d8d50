// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "supervisor/supervision/commanded_members.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/modes/under_way.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/procedures/procedure_runner.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// Brings back who crashed, and those whom its plan took down with it, to what they were commanded to be, as far as the plan says
/// (docs/adr/0076): a procedure of the telecommands of commissioning. A stop, a change of mode, another recovery or somebody
/// else's command ends it, and nobody tries again. Thread: the supervisor's.
class Restoration final : public Watch, public Undertaking {
 public:
  /// Since the newest death: who is not ready then does not come back by itself.
  static constexpr Duration patience = std::chrono::seconds{120};
  /// A member that hangs is ended within this, and what was commanded before counts.
  static constexpr Duration hang_before_death = std::chrono::seconds{20};

  Restoration(const Means& means, OwnSubsystem& own, const UnderWay& under_way)
      : means_{means}, craft_{means.craft}, own_{own}, under_way_{under_way}, runner_{means} {}

  /// It has died, or hangs and will be ended: what was commanded is looked at before its plan answers.
  void lost(std::uint16_t apid);
  /// It moves again.
  void recovered(std::uint16_t apid) { losses_.erase(apid); }
  /// Its plan has answered its death.
  void answered(std::uint16_t apid);
  /// Its process gives way to another one in Offline: what was set of it is not brought back to that, whose ids may mean something else.
  void exchanged(std::uint16_t apid) { means_.commanded.ended(apid); }
  /// Nobody comes back by itself any more.
  Cancelled cancel(std::string_view why) override;
  void all_stopped(std::string_view why) override;
  void watch(TimePoint now) override;

 private:
  /// A member with its network, as it was when it was lost.
  struct Loss {
    TimePoint at{};
    std::map<std::uint16_t, CommandedState> members;
    std::set<std::uint8_t> links;
  };
  [[nodiscard]] Loss look(std::uint16_t apid) const;
  [[nodiscard]] bool ready() const;
  /// Why it must not go on; empty: it may.
  [[nodiscard]] std::string against() const;
  /// Of them; empty: nobody was since it began.
  [[nodiscard]] std::string stopped() const;
  void begin();
  void ended(const ProcedureEnd& end);
  [[nodiscard]] std::string names() const;

  Means means_;
  Craft& craft_;
  OwnSubsystem& own_;
  const UnderWay& under_way_;
  ProcedureRunner runner_;
  std::map<std::uint16_t, Loss> losses_;
  std::set<std::uint8_t> links_;  ///< to be made
  std::map<std::uint16_t, std::uint64_t> fences_;  ///< when it began
  TimePoint deadline_{};
};

}  // namespace hirosco::supervisor
