// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"

/// Whether the cycles of a mode end in time on the one processor that they share (docs/adr/0007, 0085).
namespace hirosco::descriptor {

/// A cycle of a mode at its worst instant: all others are due when it is.
struct CycleResponse {
  std::string_view subsystem;  ///< of the mission, which outlives this
  const Configuration* configuration{nullptr};
  /// From due to done, what goes before it included; empty: it does not end before it is due again, or never.
  std::optional<Duration> longest;
};

/// The cycles that this mode commissions, the most urgent first. Who declares no budget takes nothing of the others; who runs
/// without a priority of its own goes after all that have one. Preemptive fixed priorities, of equal ones each goes once
/// before the other (M. Joseph, P. Pandya: Finding response times in a real-time system, 1986). It knows no other load than the
/// declared one: the devices that a simulation adds and the system's own work are not in it.
[[nodiscard]] std::vector<CycleResponse> cycle_responses(const Mission& mission, const Mode& mode);

}  // namespace hirosco::descriptor
