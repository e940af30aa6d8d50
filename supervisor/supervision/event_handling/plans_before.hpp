// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string_view>
#include <vector>

#include "hirosco/utilities/octets.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/event_handling/plan_runs.hpp"

namespace hirosco::supervisor {

/// Of a plan that failed. Nobody declares it: a plan may be for its severity.
inline constexpr std::string_view event_of_failure = "RECOVERY_FAILED";

/// The plans that were under way when the supervisor before this one died, and what the next one has to know of all (docs/adr/0201).
/// Adoption begins them anew.
/// Thread: the supervisor's.
class PlansBefore {
 public:
  /// The plan that answers its event now for its subject; without `planned`: none does.
  using Answer = std::function<PlanStart(const PlanUnderWay&)>;

  /// Those that are under way now are `runs`.
  PlansBefore(Craft& craft, PlanRuns& runs) : craft_{craft}, runs_{runs} {}

  /// A plan was under way for it when the supervisor before this one died, and begins anew. Not one that had been begun anew already: over
  /// it two have died.
  [[nodiscard]] bool begins_anew(std::uint16_t apid) const;
  /// It does, for this one, without what is done already. False: none answers it for this one, or this one has come elsewhere.
  bool begin_anew(Member& subject, const Answer& answer);
  /// Two supervisors have died over the plan for RECOVERY_FAILED that was under way for it.
  [[nodiscard]] bool is_spent(std::uint16_t apid) const { return spent_.contains(apid); }
  /// The plan for RECOVERY_FAILED is about to begin for it instead of what was under way.
  void counts_as_failed(std::uint16_t apid);
  /// What has not begun anew by now does not any more.
  void forget() noexcept {
    before_.clear();
    answered_ = true;
  }
  /// What is under way, or was under the supervisor before.
  void note(OctetWriter& writer) const;
  void recall(OctetReader& reader);

 private:
  Craft& craft_;
  PlanRuns& runs_;
  std::vector<PlanUnderWay> before_;
  std::set<std::uint16_t> spent_;
  bool answered_{false};  ///< nothing of `before_` is still to be answered
};

}  // namespace hirosco::supervisor
