// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What happens when a cycle's own work takes longer than its period: each is counted, and so many in a row as the descriptor says
/// (`overruns`, without real time `overruns_reduced`) raise CYCLE_OVERRUNS. A cycle that is woken late is no overrun: that is latency,
/// and what was slept through is missed (`cycle_pace.hpp`, docs/adr/0007). Thread: the cycle's, begin() while it rests.
class OverrunWatch {
 public:
  void begin(const descriptor::Configuration& configuration, bool realtime) noexcept;
  /// After each cycle, which started `late` after its planned instant. Work that takes long after a start more than a period late tells
  /// of the machine: it neither lengthens the row nor breaks it.
  /// \return true when the row reaches the limit, once for each such row.  Realtime: wait-free.
  [[nodiscard]] bool account(Duration execution, Duration late) noexcept;
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] std::uint32_t in_a_row() const noexcept { return in_a_row_; }

 private:
  Duration period_{};
  std::uint32_t limit_{1};
  std::uint32_t in_a_row_{0};
  std::uint64_t count_{0};
};

}  // namespace hirosco
