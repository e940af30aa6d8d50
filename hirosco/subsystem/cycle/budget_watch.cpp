// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/budget_watch.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace hirosco {
namespace {

[[nodiscard]] float in_us(Duration span) noexcept { return std::chrono::duration<float, std::micro>{span}.count(); }

}  // namespace

void BudgetWatch::begin(const descriptor::Configuration& configuration, bool realtime, Duration spin) noexcept {
  budget_ = configuration.budget;
  limit_ = realtime ? configuration.overruns.realtime : configuration.overruns.reduced;
  before_.reset();
  in_a_row_ = 0;
  told_ = {.budget_us = in_us(budget_)};
  spin_ = spin;
  spun_ = {};
  told_spin_ = {.spin_us = in_us(spin_)};
}

void BudgetWatch::account_spin(Duration spun) noexcept {
  spun_ = spun;
  told_spin_.longest_us = std::max(told_spin_.longest_us, in_us(spun));
  if (spun > spin_) ++told_spin_.exceeded;
}

bool BudgetWatch::account(Duration used) noexcept {
  const auto before = std::exchange(before_, used);
  const Duration spun = std::exchange(spun_, Duration{});
  if (!before) return false;
  const Duration taken = used - *before - spun;
  told_.longest_us = std::max(told_.longest_us, in_us(taken));
  // Others wait for whoever spins too long as for whoever works too long.
  if (spun <= spin_ && (budget_ == Duration{} || taken <= budget_)) {
    in_a_row_ = 0;
    return false;
  }
  if (budget_ != Duration{} && taken > budget_) ++told_.exceeded;
  return ++in_a_row_ == limit_;
}

}  // namespace hirosco
