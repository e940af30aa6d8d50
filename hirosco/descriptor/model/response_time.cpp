// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/response_time.hpp"

#include <algorithm>
#include <array>

namespace hirosco::descriptor {
namespace {

[[nodiscard]] std::int64_t begun_within(Duration span, Duration period) {
  return (span + period - Duration{1}) / period;
}

/// Who runs, in each way in which it may: of a cycle there is one, a loop of services may go otherwise in a configuration. It goes in one
/// of them at a time.
struct Runner {
  std::array<CycleResponse, 2> ways;
  std::size_t count{1};
  [[nodiscard]] std::span<const CycleResponse> each() const noexcept { return std::span{ways}.first(count); }
};

/// What this one takes from `of` until that has ended, if it began with all due and took `span`.
[[nodiscard]] Duration taken(const CycleResponse& other, const CycleResponse& of, Duration span) {
  if (other.priority() < of.priority()) return Duration{};
  const bool in_turn =
      other.priority() == of.priority() && of.priority() > 0;  // without a priority nobody keeps a turn
  return in_turn ? other.load() : begun_within(span, other.period()) * other.load();
}

/// Of who may run in several ways, in the worst for `of`.
[[nodiscard]] Duration demand(std::span<const Runner> all, const Runner& own, const CycleResponse& of, Duration span) {
  Duration sum = of.load();
  for (const Runner& runner : all) {
    if (&runner == &own) continue;
    Duration most{};
    for (const CycleResponse& other : runner.each()) most = std::max(most, taken(other, of, span));
    sum += most;
  }
  return sum;
}

[[nodiscard]] std::optional<Duration> longest(std::span<const Runner> all, const Runner& own, const CycleResponse& of) {
  // Each round is longer by a budget at least, so that it ends at the period at the latest.
  // It counts from when the cycle takes the processor, which a precise one does before it is due.
  for (Duration span = std::max(of.load(), Duration{1}); span <= of.period();) {
    const Duration needed = demand(all, own, of, span);
    if (needed == span) return span - of.spin();
    span = needed;
  }
  return std::nullopt;
}

[[nodiscard]] std::vector<CycleResponse> responses(std::span<const Runner> all) {
  std::vector<CycleResponse> cycles;
  for (const Runner& runner : all)
    for (CycleResponse cycle : runner.each()) {
      cycle.longest = longest(all, runner, cycle);
      cycles.push_back(cycle);
    }
  std::ranges::stable_sort(cycles, std::ranges::greater{}, &CycleResponse::priority);
  return cycles;
}

[[nodiscard]] std::vector<Runner> runners(std::span<const InForce> all) {
  std::vector<Runner> found;
  for (const auto& [subsystem, configuration] : all) {
    if (configuration != nullptr && configuration->shortest() > Duration{})
      found.push_back({{CycleResponse{subsystem->name, configuration, nullptr, std::nullopt}}});
    for (std::size_t i = 0; i < subsystem->service_loops.size(); ++i)
      if (const ServiceLoop& loop = subsystem->loop_in_force(i, configuration); loop.period > Duration{})
        found.push_back({{CycleResponse{subsystem->name, nullptr, &loop, std::nullopt}}});
  }
  return found;
}

[[nodiscard]] std::vector<InForce> in_force_in(const Mission& mission, const Mode& mode) {
  std::vector<InForce> all;
  for (const CommissionStep& step : mode.commission)
    if (const auto* member = mission.find_subsystem(step.subsystem))
      all.push_back({&member->subsystem, member->subsystem.find_configuration(step.configuration)});
  // Loops of services run whatever is commissioned.
  for (const MissionSubsystem& member : mission.subsystems)
    if (std::ranges::find(all, &member.subsystem, &InForce::subsystem) == all.end())
      all.push_back({&member.subsystem, nullptr});
  return all;
}

}  // namespace

std::vector<CycleResponse> cycle_responses(std::span<const InForce> all) { return responses(runners(all)); }

std::vector<CycleResponse> cycle_responses(const Mission& mission, const Mode& mode) {
  return cycle_responses(in_force_in(mission, mode));
}

std::vector<CycleResponse> cycle_responses_around(const Mission& mission, const Mode& mode) {
  const std::vector<InForce> all = in_force_in(mission, mode);
  std::vector<Runner> found = runners(all);
  for (Runner& runner : found) {
    const ServiceLoop* const loop = runner.ways[0].loop;
    if (loop == nullptr) continue;
    const SubsystemDescriptor& subsystem = *std::ranges::find(all, runner.ways[0].subsystem, [](const InForce& each) {
                                              return std::string_view{each.subsystem->name};
                                            })->subsystem;
    const auto own = std::ranges::find(subsystem.service_loops, loop->name, &ServiceLoop::name);
    if (&*own == loop || own->period == Duration{}) continue;
    runner.ways[1] = {subsystem.name, nullptr, &*own, std::nullopt};
    runner.count = 2;
  }
  return responses(found);
}

}  // namespace hirosco::descriptor
