// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/resource_management/measured_budget.hpp"
#include "supervisor/supervision/resource_management/power_ledger.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

class Reactions;

/// Keeps the ledger of electrical power true, and acts when the budget falls (paper 4.3 resource management). Where a subsystem measures
/// the budget it decides what is granted; what is taken is left to the plans of the mission.
/// Thread: the supervisor's.
class PowerHandling final : public Watch, public Hearer, public Remembered {
 public:
  PowerHandling(Craft& craft, OwnSubsystem& own, Reactions& reactions)
      : craft_{craft}, own_{own}, reactions_{reactions}, ledger_{craft.mission.power_budget_w} {
    measure();
  }

  /// SET_POWER_BUDGET.
  void provide();
  [[nodiscard]] PowerLedger& ledger() noexcept { return ledger_; }
  [[nodiscard]] const PowerLedger& ledger() const noexcept { return ledger_; }
  /// What everybody draws by its state and configuration.
  void observe();
  /// A telecommand was refused for it: it is told, and answered by the plan for it. What that plan asks for at once and is refused for the
  /// same reason is told and no more: without end it would be answered within its own answer (docs/adr/0226).
  void tell_shortage(std::uint16_t apid, const pus::FailureNotice& notice);
  /// A failure of any stage, or completion: what was reserved for the telecommand is over; each other stage: it is still to come. And
  /// what is measured.
  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  void watch(TimePoint now) override;
  /// The budget, where a telecommand has set it.
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;

 private:
  void set_budget(double budget_w);
  void shed_load();
  void measure();
  void follow_measurement();
  [[nodiscard]] std::string basis() const;

  Craft& craft_;
  OwnSubsystem& own_;
  Reactions& reactions_;
  PowerLedger ledger_;
  std::optional<double> set_w_;
  std::optional<MeasuredBudget> measured_;
  bool known_{false};  ///< as it was told last
  bool answering_{false};  ///< a plan for a shortage begins
};

}  // namespace hirosco::supervisor
