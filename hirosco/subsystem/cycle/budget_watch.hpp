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

/// How a precise cycle waits for its instant (docs/adr/0104), as a parameter of every subsystem: CYCLE_SPIN.
struct CycleSpin {
  float spin_us{
      0.0F};  ///< before each cycle it may spin so long; 0 = it sleeps, as it is not asked to spin or is not let
  float longest_us{0.0F};  ///< of the processor before one cycle, since the configuration was applied
  std::uint64_t exceeded{0};  ///< times that it took more
};

/// Holds the cycle to its budget (docs/adr/0085), in processor time: what others take while it waits is in nobody's budget
/// but theirs. Thread: the cycle's, begin() while it rests.
class BudgetWatch {
 public:
  /// `spin`: what it may spin away before each cycle, and what its platform lets it.
  void begin(const descriptor::Configuration& configuration, bool realtime, Duration spin = {}) noexcept;
  /// Before account(), of a cycle that has spun for so long: it is none of its work, and is held against the declared spin.
  /// Realtime: wait-free.
  void account_spin(Duration spun) noexcept;
  /// After each cycle. `used`: by the cycle's thread since it was made. The first one only says from where to count.
  /// \return true when so many cycles in a row as the limit of overruns took too long, once for each such row.
  /// Realtime: wait-free.
  [[nodiscard]] bool account(Duration used) noexcept;
  [[nodiscard]] const CycleBudget& told() const noexcept { return told_; }
  [[nodiscard]] const CycleSpin& told_spin() const noexcept { return told_spin_; }
  [[nodiscard]] std::uint32_t in_a_row() const noexcept { return in_a_row_; }

 private:
  Duration budget_{};
  std::uint32_t limit_{1};
  Duration spin_{};
  Duration spun_{};  ///< before this cycle
  std::optional<Duration> before_;
  std::uint32_t in_a_row_{0};
  CycleBudget told_;
  CycleSpin told_spin_;
};

}  // namespace hirosco
