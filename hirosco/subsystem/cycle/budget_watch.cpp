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

void BudgetWatch::begin(const descriptor::Configuration& configuration, bool realtime) noexcept {
  budget_ = configuration.budget;
  limit_ = realtime ? configuration.overruns.realtime : configuration.overruns.reduced;
  before_.reset();
  in_a_row_ = 0;
  told_ = {.budget_us = in_us(budget_)};
}

bool BudgetWatch::account(Duration used) noexcept {
  const auto before = std::exchange(before_, used);
  if (!before) return false;
  const Duration taken = used - *before;
  told_.longest_us = std::max(told_.longest_us, in_us(taken));
  if (budget_ == Duration{} || taken <= budget_) {
    in_a_row_ = 0;
    return false;
  }
  ++told_.exceeded;
  return ++in_a_row_ == limit_;
}

}  // namespace hirosco
