// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <span>

#include "supervisor/supervision/procedures/step.hpp"

/// Which of two plans a member follows (docs/adr/0090).
namespace hirosco::supervisor {

/// The order counts: what is safer goes first whatever its number, then the mission's priority, then the event's severity.
struct PlanRank {
  Safety safety{};
  std::uint8_t priority{};
  descriptor::Severity severity{};
  friend auto operator<=>(const PlanRank&, const PlanRank&) = default;
};

/// The most that these do.
[[nodiscard]] inline Safety safety_of(std::span<const ProcedureStep> steps) {
  Safety most = Safety::None;
  for (const ProcedureStep& each : steps)
    if (each.kind->safety != nullptr) most = std::max(most, each.kind->safety(each));
  return most;
}

/// A new one begins, and ends what runs. Of equals the first goes on.
[[nodiscard]] constexpr bool pre_empts(const PlanRank& begins, const PlanRank& runs) { return begins > runs; }

}  // namespace hirosco::supervisor
