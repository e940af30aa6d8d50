// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/response_time.hpp"

#include <algorithm>
#include <array>

#include "hirosco/descriptor/model/cores.hpp"

namespace hirosco::descriptor {
namespace {

[[nodiscard]] std::int64_t begun_within(Duration span, Duration period) {
  return (span + period - Duration{1}) / period;
}

/// A subsystem has its configuration in force, or not: before it and behind it there is no cycle, and its loops go as it says itself.
enum class When { Always, Configured, Unconfigured };

struct Way {
  CycleResponse response;
  When when{When::Always};
};

[[nodiscard]] bool never_at_once(const Way& one, const Way& other) {
  return one.response.subsystem == other.response.subsystem && one.when != other.when && one.when != When::Always &&
         other.when != When::Always;
}

/// Who runs, in each way in which it may: of a cycle there is one, a loop of services may go otherwise in a configuration. It goes in one
/// of them at a time.
struct Runner {
  std::array<Way, 2> ways;
  std::size_t count{0};
  [[nodiscard]] std::span<const Way> each() const noexcept { return std::span{ways}.first(count); }
  void may(const CycleResponse& response, When when) {
    if (response.period() > Duration{}) ways[count++] = {response, when};
  }
};

/// What this one takes from `of` until that has ended, if it began with all due and took `span`.
[[nodiscard]] Duration taken(const CycleResponse& other, const CycleResponse& of, Duration span) {
  if (other.core != of.core || other.priority() < of.priority()) return Duration{};
  const bool in_turn =
      other.priority() == of.priority() && of.priority() > 0;  // without a priority nobody keeps a turn
  return in_turn ? other.load() : begun_within(span, other.period()) * other.load();
}

/// Of who may run in several ways, in the worst for `of`.
[[nodiscard]] Duration demand(std::span<const Runner> all, const Runner& own, const Way& of, Duration span) {
  Duration sum = of.response.load();
  for (const Runner& runner : all) {
    if (&runner == &own) continue;
    Duration most{};
    for (const Way& other : runner.each())
      if (!never_at_once(other, of)) most = std::max(most, taken(other.response, of.response, span));
    sum += most;
  }
  return sum;
}

[[nodiscard]] std::optional<Duration> longest(std::span<const Runner> all, const Runner& own, const Way& of) {
  // Each round is longer, by a microsecond of a budget at least, so that it ends at the period at the latest.
  // It counts from when the cycle takes the processor, which a precise one does before it is due.
  for (Duration span = std::max(of.response.load(), Duration{1}); span <= of.response.period();) {
    const Duration needed = demand(all, own, of, span);
    if (needed == span) return span - of.response.spin();
    span = needed;
  }
  return std::nullopt;
}

[[nodiscard]] std::vector<CycleResponse> responses(std::span<const Runner> all) {
  std::vector<CycleResponse> cycles;
  for (const Runner& runner : all)
    for (const Way& way : runner.each()) {
      cycles.push_back(way.response);
      cycles.back().longest = longest(all, runner, way);
    }
  std::ranges::stable_sort(cycles, std::ranges::greater{}, &CycleResponse::priority);
  return cycles;
}

enum class Reckoned { AsInForce, AlsoUnconfigured };

[[nodiscard]] std::vector<Runner> runners(std::span<const InForce> all, Reckoned reckoned) {
  std::vector<Runner> found;
  for (const auto& [subsystem, configuration, core] : all) {
    if (configuration != nullptr)
      found.emplace_back().may({subsystem->name, configuration, nullptr, std::nullopt, core}, When::Configured);
    for (std::size_t i = 0; i < subsystem->service_loops.size(); ++i) {
      const ServiceLoop &own = subsystem->service_loops[i], &now = subsystem->loop_in_force(i, configuration);
      const bool goes_otherwise = &now != &own && reckoned == Reckoned::AlsoUnconfigured;
      Runner& loop = found.emplace_back();
      loop.may({subsystem->name, nullptr, &now, std::nullopt, core}, goes_otherwise ? When::Configured : When::Always);
      if (goes_otherwise) loop.may({subsystem->name, nullptr, &own, std::nullopt, core}, When::Unconfigured);
    }
  }
  return found;
}

[[nodiscard]] std::vector<InForce> in_force_in(const Mission& mission, const Mode& mode) {
  std::vector<InForce> all;
  for (const CommissionStep& step : mode.commission)
    if (const auto* member = mission.find_subsystem(step.subsystem))
      all.push_back(
          {&member->subsystem, member->subsystem.find_configuration(step.configuration), core_of(mission, *member)});
  // Loops of services run whatever is commissioned.
  for (const MissionSubsystem& member : mission.subsystems)
    if (std::ranges::find(all, &member.subsystem, &InForce::subsystem) == all.end())
      all.push_back({&member.subsystem, nullptr, core_of(mission, member)});
  return all;
}

}  // namespace

std::vector<CycleResponse> cycle_responses(std::span<const InForce> all) {
  return responses(runners(all, Reckoned::AsInForce));
}

std::vector<CycleResponse> cycle_responses(const Mission& mission, const Mode& mode) {
  return cycle_responses(in_force_in(mission, mode));
}

std::vector<CycleResponse> cycle_responses_around(std::span<const InForce> all) {
  return responses(runners(all, Reckoned::AlsoUnconfigured));
}

std::vector<CycleResponse> cycle_responses_around(const Mission& mission, const Mode& mode) {
  return cycle_responses_around(in_force_in(mission, mode));
}

}  // namespace hirosco::descriptor
