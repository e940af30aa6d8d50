// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/descriptor/model/subsystem.hpp"

namespace hirosco {

/// What the cycles of a configuration take of their processor beside what its descriptor promises, as a parameter of every
/// subsystem: CYCLE_BUDGET.
struct CycleBudget {
  float budget_us{0.0F};  ///< 0 = none is declared
  float longest_us{0.0F};  ///< of one cycle since the configuration was applied
  std::uint32_t exceeded{0};  ///< cycles that took more than the budget
};

/// Holds the cycle to its budget (docs/adr/0085), in processor time: what others take while it waits is in nobody's budget
/// but theirs. Thread: the cycle's, begin() while it rests.
class BudgetWatch {
 public:
  void begin(const descriptor::Configuration& configuration, bool realtime) noexcept;
  /// After each cycle. `used`: by the cycle's thread since it was made. The first one only says from where to count.
  /// \return true when so many cycles in a row as the limit of overruns took too long, once for each such row.
  /// Realtime: wait-free.
  [[nodiscard]] bool account(Duration used) noexcept;
  [[nodiscard]] const CycleBudget& told() const noexcept { return told_; }
  [[nodiscard]] std::uint32_t in_a_row() const noexcept { return in_a_row_; }

 private:
  Duration budget_{};
  std::uint32_t limit_{1};
  std::optional<Duration> before_;
  std::uint32_t in_a_row_{0};
  CycleBudget told_;
};

}  // namespace hirosco
