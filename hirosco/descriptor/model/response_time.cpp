// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/response_time.hpp"

#include <algorithm>

namespace hirosco::descriptor {
namespace {

[[nodiscard]] std::int64_t begun_within(Duration span, Duration period) {
  return (span + period - Duration{1}) / period;
}

/// What all of `cycles` takes from one of them until it has ended, if that began with all due and took `span`.
[[nodiscard]] Duration demand(const std::vector<CycleResponse>& cycles, const Configuration& of, Duration span) {
  Duration sum = of.budget;
  for (const CycleResponse& cycle : cycles) {
    const Configuration& other = *cycle.configuration;
    if (&other == &of || other.priority < of.priority) continue;
    const bool in_turn = other.priority == of.priority && of.priority > 0;  // without a priority nobody keeps a turn
    sum += in_turn ? other.budget : begun_within(span, other.shortest()) * other.budget;
  }
  return sum;
}

[[nodiscard]] std::optional<Duration> longest(const std::vector<CycleResponse>& cycles, const Configuration& of) {
  // Each round is longer by a budget at least, so that it ends at the period at the latest.
  for (Duration span = std::max(of.budget, Duration{1}); span <= of.shortest();) {
    const Duration needed = demand(cycles, of, span);
    if (needed == span) return span;
    span = needed;
  }
  return std::nullopt;
}

}  // namespace

std::vector<CycleResponse> cycle_responses(const Mission& mission, const Mode& mode) {
  std::vector<CycleResponse> cycles;
  for (const CommissionStep& step : mode.commission) {
    const auto* member = mission.find_subsystem(step.subsystem);
    const auto* configuration = member == nullptr ? nullptr : member->subsystem.find_configuration(step.configuration);
    if (configuration != nullptr && configuration->shortest() > Duration{})
      cycles.push_back({member->subsystem.name, configuration, std::nullopt});
  }
  std::ranges::stable_sort(cycles, std::ranges::greater{},
                           [](const CycleResponse& cycle) { return cycle.configuration->priority; });
  for (CycleResponse& cycle : cycles) cycle.longest = longest(cycles, *cycle.configuration);
  return cycles;
}

}  // namespace hirosco::descriptor
