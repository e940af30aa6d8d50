// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "supervisor/supervision/procedures/procedure_runner.hpp"
#include "supervisor/supervision/resource_management/power_ledger.hpp"

/// A change of mode, thought out before anything moves (docs/adr/0075): who moves, in which stages, and all that is against it.
namespace hirosco::supervisor {

struct ModePlan {
  std::vector<Stage> stages;  ///< none is empty; none at all: what is permitted changes, nothing else
  std::vector<std::uint16_t> moved;  ///< APIDs, in the order of the mission
  std::vector<std::string> against;  ///< every reason why it is impossible now, in words; empty: it is possible
  std::vector<std::uint16_t> released{};  ///< of those who are moved: who is let move, in Operational
};

/// Whose states interlocks are judged on. What a change of mode brings about itself is no reason against it: at its end those are left
/// out whom it commissions.
enum class Judged : std::uint8_t { Everybody, WhomItDoesNotCommission };

/// What guards a mode, whoever brings the craft there: the modes that it is entered from, states of others that it needs or excludes.
/// Every reason why it may not be entered now, in words; empty: it may. Pure. Thread: the supervisor's.
[[nodiscard]] std::vector<std::string> interlocks_against(const Craft& craft, const descriptor::Mode& mode,
                                                          Judged judged);

/// What of `mode` is not there: whom it commissions, each in its state and configuration, and the links that it establishes. By the rule
/// by which plan_mode() leaves out what is there already. In words; empty: the mode is there. Pure. Thread: the supervisor's.
[[nodiscard]] std::string missing_from(const Craft& craft, const LinkGraph& links, const descriptor::Mode& mode);

/// What brings the craft into `mode` from where it is. A mode that commissions somebody is one of the whole craft: who is not named goes
/// Offline, but for the ground link, and links that it does not establish are given back. Who has to move takes its real-time
/// network along. A mode that commissions nobody moves nobody.
/// Pure: nothing is sent or told. Thread: the supervisor's.
[[nodiscard]] ModePlan plan_mode(const Craft& craft, const LinkGraph& links, const PowerLedger& power,
                                 const descriptor::Mode& mode);

}  // namespace hirosco::supervisor
