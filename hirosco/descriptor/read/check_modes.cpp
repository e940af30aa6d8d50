// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "hirosco/descriptor/read/detail/mode_parts.hpp"

/// What modes need of each other, looked at when all are known; what each needs by itself: check_mode.cpp.
namespace hirosco::descriptor::detail {
namespace {

constexpr std::array<std::string_view, 2> ways_to_a_mode{"ENTER_MODE", "SET_MODE"};

[[nodiscard]] bool opens_of_supervisor(const Permit& permit, std::string_view function, const Mission& mission) {
  if (permit.subsystem != "*" && permit.subsystem != mission.supervisor.name) return false;
  return std::ranges::any_of(permit.functions,
                             [&](const std::string& each) { return each == "*" || each == function; });
}

[[nodiscard]] bool may_ask_for_modes(const MissionSubsystem& member, const Permit& permit, const Mission& mission) {
  if (!permit.names(member.subsystem.name)) return false;
  return std::ranges::any_of(ways_to_a_mode, [&](std::string_view way) {
    const auto declares = [&](const Commands& commands) {
      return commands.apid == mission.supervisor.id &&
             std::ranges::find(commands.functions, way) != commands.functions.end();
    };
    return opens_of_supervisor(permit, way, mission) && std::ranges::any_of(member.subsystem.commands, declares);
  });
}

[[nodiscard]] bool ground_may_leave(const Mode& mode, const Mission& mission) {
  return std::ranges::any_of(mode.permits, [&](const Permit& permit) {
    const bool for_ground = permit.from.empty() || permit.names(ground_origin);
    return for_ground && std::ranges::any_of(ways_to_a_mode, [&](std::string_view way) {
             return opens_of_supervisor(permit, way, mission);
           });
  });
}

}  // namespace

void check_way_back(const Mission& mission, Problems& problems) {
  const MissionSubsystem* asks = nullptr;
  for (const Mode& mode : mission.modes)
    for (const Permit& permit : mode.permits)
      for (const MissionSubsystem& member : mission.subsystems)
        if (asks == nullptr && may_ask_for_modes(member, permit, mission)) asks = &member;
  if (asks == nullptr) return;
  for (const Mode& mode : mission.modes)
    if (!ground_may_leave(mode, mission))
      problems.add(mode.at, "E0357",
                   fmt::format("the ground may not leave mode {}, and '{}' may ask for modes", in_quotes(mode.name),
                               asks->subsystem.name),
                   fmt::format("<Permit subsystem=\"{}\" functions=\"SET_MODE\"/> in it", mission.supervisor.name), 5);
}

void check_from(const xml::Element& modes, const Mission& mission, Problems& problems) {
  std::vector<std::string_view> known;
  for (const Mode& candidate : mission.modes) known.push_back(candidate.name);
  for (const xml::Element& element : modes.children) {
    const auto* at = element.find("from");
    if (at == nullptr) continue;
    if (words(at->value).empty()) problems.add(*at, "E0109", "attribute 'from' is empty");
    for (const auto word : words(at->value))
      if (mission.find_mode(word) == nullptr)
        problems.add(*at, "E0305", fmt::format("mode {} is not defined", in_quotes(word)), did_you_mean(word, known));
  }
}

void check_initial(const xml::Attribute& initial, const Mode& mode, Problems& problems) {
  for (const std::string& why : against_beginning(mode))
    problems.add(initial, "E0356", fmt::format("mode {} cannot be the initial one: {}", in_quotes(mode.name), why),
                 "it is in force from the beginning, with every subsystem Offline");
}

void check_start(const xml::Attribute& start, const Mode& mode, const Mission& mission, Problems& problems) {
  for (const std::string& why : against_start(mission, mode))
    problems.add(start, "E0330", fmt::format("mode {} cannot be the first: {}", in_quotes(mode.name), why),
                 "commissioning begins in the initial mode, with every subsystem Offline");
}

}  // namespace hirosco::descriptor::detail
