// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/cycle/resource_meter.hpp"
#include "hirosco/utilities/os/clock.hpp"

namespace hirosco {

/// Everything a subsystem needs from outside (architecture, rule 3).
struct Platform {
  const Clock& clock;
  MemoryProvider& memory;
  FlowFactory& flows;
  bool realtime{true};               ///< SCHED_FIFO is granted; false: the reduced limits hold (decision 21)
  /// A cycle that asks for it may spin until it is due (docs/adr/0104): it has real-time rights, and whoever is no cycle another processor.
  bool precise{false};
  /// Whoever drives the service loop steps it when the cycle has something to report (has_reports()), so that it need not look every
  /// millisecond while a cycle runs (adr 0071).
  bool wakes{false};
  /// Explains to a developer why something was refused (standard error, a test's list). Service loop only.
  std::function<void(std::string_view)> explain{};
  LinkMechanisms links{standard_link_mechanisms()};
  /// What the process has taken, empty when nobody can tell; asked ten times in a second. Service loop only.
  std::function<std::optional<ProcessUsage>()> usage{};
  /// Reads another text of its descriptor, with what its mission changes applied (docs/adr/0095). Service loop only; null: it keeps
  /// the one that it began with.
  std::function<descriptor::Reading<descriptor::SubsystemDescriptor>(std::string_view text)> read_again{};
};

}  // namespace hirosco
