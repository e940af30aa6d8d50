// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/resource_management/measured_budget.hpp"
#include "supervisor/supervision/resource_management/power_ledger.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

class Reactions;

/// What members draw of electrical power, as the mission says who measures it, held against what they hold in the books (docs/adr/0237). More than that for
/// longer than the mission permits is told once, with each one's name, and answered by its plan. A measurement that is old, or of nobody who runs,
/// is no excess, and no end of one.  Thread: the supervisor's.
class PowerDraws final : public Watch, public Hearer {
 public:
  PowerDraws(Craft& craft, OwnSubsystem& own, Reactions& reactions, const PowerLedger& ledger);

  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  void watch(TimePoint now) override;

 private:
  struct Watched {
    const descriptor::PowerDraw* declared;
    MeasuredBudget drawn;
    std::optional<TimePoint> since{};  ///< it is drawn more than may be
    bool told{false};
  };
  void judge(Watched& watched, TimePoint now);
  void tell_excess(const Watched& watched, double drawn_w, double may_w);
  [[nodiscard]] double claimed_w(const descriptor::PowerDraw& draw) const noexcept;
  [[nodiscard]] std::string names(const descriptor::PowerDraw& draw) const;

  Craft& craft_;
  OwnSubsystem& own_;
  Reactions& reactions_;
  const PowerLedger& ledger_;
  std::vector<Watched> watched_;
};

}  // namespace hirosco::supervisor
