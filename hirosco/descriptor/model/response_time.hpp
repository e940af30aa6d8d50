// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"

/// Whether the cycles of a mode end in time on the core that they share (docs/adr/0007, 0085), or that they are given (docs/adr/0234).
namespace hirosco::descriptor {

/// A cycle of a mode, or a loop of services of its own, at its worst instant: all others of its core are due when it is.
struct CycleResponse {
  std::string_view subsystem;  ///< of the mission, which outlives this
  const Configuration* configuration{nullptr};  ///< of a cycle
  const ServiceLoop* loop{nullptr};  ///< of services, instead (docs/adr/0096)
  /// From due to done, what goes before it included; empty: it does not end before it is due again, or never.
  std::optional<Duration> longest;
  /// On which it goes, and takes nothing of any other; empty: on that of all who name none.
  std::optional<std::uint16_t> core{};

  [[nodiscard]] std::string_view name() const noexcept { return loop != nullptr ? loop->name : configuration->name; }
  /// The shortest.
  [[nodiscard]] Duration period() const noexcept { return loop != nullptr ? loop->period : configuration->shortest(); }
  [[nodiscard]] Duration budget() const noexcept { return loop != nullptr ? loop->budget : configuration->budget; }
  /// Before it is due it keeps the processor for so long, as whoever works would (docs/adr/0104).
  [[nodiscard]] Duration spin() const noexcept { return loop != nullptr ? Duration{} : configuration->spin; }
  [[nodiscard]] Duration load() const noexcept { return budget() + spin(); }
  [[nodiscard]] int priority() const noexcept { return loop != nullptr ? loop->priority : configuration->priority; }
};

/// A subsystem and what is in force of it; null: it does not cycle.
struct InForce {
  const SubsystemDescriptor* subsystem{nullptr};
  const Configuration* configuration{nullptr};
  std::optional<std::uint16_t> core{};  ///< core_of()
};

/// The cycles that this mode commissions and the loops of services of all subsystems, the most urgent first. Who declares no budget
/// takes nothing of the others; who runs without a priority of its own goes after all that have one. Preemptive fixed priorities, of
/// equal ones each goes once before the other (M. Joseph, P. Pandya: Finding response times in a real-time system, 1986). It knows no
/// other load than the declared one: the devices that a simulation adds and the system's own work are not in it.
[[nodiscard]] std::vector<CycleResponse> cycle_responses(const Mission& mission, const Mode& mode);
/// The same whichever of these subsystems are configured just then, as on the way into the mode and out of it, or where one of them is
/// brought back: until it is, its loops go as it says itself, and one that its configuration has go otherwise stands there twice
/// (docs/adr/0207). Each is held to the worst of what the others may be; of its own subsystem, to what is at the same time as it.
[[nodiscard]] std::vector<CycleResponse> cycle_responses_around(const Mission& mission, const Mode& mode);
/// The same of what is in force, whatever mode.
[[nodiscard]] std::vector<CycleResponse> cycle_responses(std::span<const InForce> all);
[[nodiscard]] std::vector<CycleResponse> cycle_responses_around(std::span<const InForce> all);

}  // namespace hirosco::descriptor
