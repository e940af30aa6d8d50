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
[[nodiscard]] Duration demand(const std::vector<CycleResponse>& cycles, const CycleResponse& of, Duration span) {
  Duration sum = of.load();
  for (const CycleResponse& other : cycles) {
    if (&other == &of || other.priority() < of.priority()) continue;
    const bool in_turn =
        other.priority() == of.priority() && of.priority() > 0;  // without a priority nobody keeps a turn
    sum += in_turn ? other.load() : begun_within(span, other.period()) * other.load();
  }
  return sum;
}

[[nodiscard]] std::optional<Duration> longest(const std::vector<CycleResponse>& cycles, const CycleResponse& of) {
  // Each round is longer by a budget at least, so that it ends at the period at the latest.
  // It counts from when the cycle takes the processor, which a precise one does before it is due.
  for (Duration span = std::max(of.load(), Duration{1}); span <= of.period();) {
    const Duration needed = demand(cycles, of, span);
    if (needed == span) return span - of.spin();
    span = needed;
  }
  return std::nullopt;
}

}  // namespace

std::vector<CycleResponse> cycle_responses(std::span<const InForce> all) {
  std::vector<CycleResponse> cycles;
  for (const auto& [subsystem, configuration] : all) {
    if (configuration != nullptr && configuration->shortest() > Duration{})
      cycles.push_back({subsystem->name, configuration, nullptr, std::nullopt});
    for (const ServiceLoop& loop : subsystem->service_loops)
      if (loop.period > Duration{}) cycles.push_back({subsystem->name, nullptr, &loop, std::nullopt});
  }
  std::ranges::stable_sort(cycles, std::ranges::greater{}, &CycleResponse::priority);
  for (CycleResponse& cycle : cycles) cycle.longest = longest(cycles, cycle);
  return cycles;
}

std::vector<CycleResponse> cycle_responses(const Mission& mission, const Mode& mode) {
  std::vector<InForce> all;
  for (const CommissionStep& step : mode.commission)
    if (const auto* member = mission.find_subsystem(step.subsystem))
      all.push_back({&member->subsystem, member->subsystem.find_configuration(step.configuration)});
  // Loops of services run whatever is commissioned.
  for (const MissionSubsystem& member : mission.subsystems)
    if (std::ranges::find(all, &member.subsystem, &InForce::subsystem) == all.end())
      all.push_back({&member.subsystem, nullptr});
  return cycle_responses(all);
}

}  // namespace hirosco::descriptor
