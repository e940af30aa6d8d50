// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/mission.hpp"

/// What has to hold before a mode is entered (docs/adr/0075).
namespace hirosco::descriptor {

std::string to_string(const Interlock& interlock) {
  std::string states;
  for (const State state : interlock.states) states += (states.empty() ? "" : " or ") + std::string{to_text(state)};
  return interlock.subsystem + " in " + states +
         (interlock.configuration.empty() ? "" : " with " + interlock.configuration);
}

std::vector<std::string> against_beginning(const Mode& mode) {
  std::vector<std::string> against;
  for (const Interlock& interlock : mode.interlocks) {
    const bool holds = std::ranges::find(interlock.states, State::Offline) != interlock.states.end() &&
                       interlock.configuration.empty();
    if (holds == (interlock.kind == Interlock::Kind::Excludes))
      against.push_back(fmt::format("it {} {}", holds ? "excludes" : "needs", to_string(interlock)));
  }
  return against;
}

std::vector<std::string> against_start(const Mission& mission, const Mode& mode) {
  std::vector<std::string> against;
  if (!mode.from.empty() && std::ranges::find(mode.from, mission.initial_mode) == mode.from.end())
    against.push_back(fmt::format("it is not entered from '{}'", mission.initial_mode));
  for (const CommissionStep& step : mode.commission)
    if (const auto* member = mission.find_subsystem(step.subsystem); member != nullptr && !member->starts)
      against.push_back(fmt::format("it commissions {}, which is not started with the flight", step.subsystem));
  for (std::string& why : against_beginning(mode)) against.push_back(std::move(why));
  return against;
}

std::optional<std::string> start_in(Mission& mission, std::string_view name) {
  const Mode* mode = mission.find_mode(name);
  if (mode == nullptr) {
    std::vector<std::string_view> known;
    for (const Mode& each : mission.modes) known.push_back(each.name);
    return fmt::format("mission {} has no mode '{}': {}", mission.name, name, fmt::join(known, ", "));
  }
  if (const auto against = against_start(mission, *mode); !against.empty())
    return fmt::format("mode '{}' cannot be the first: {}", name, fmt::join(against, "; "));
  mission.start_mode = name;
  return std::nullopt;
}

}  // namespace hirosco::descriptor
