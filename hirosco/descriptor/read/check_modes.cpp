// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "hirosco/descriptor/read/detail/mode_parts.hpp"

/// What modes need of each other, looked at when all are known; what each needs by itself: check_mode.cpp.
namespace hirosco::descriptor::detail {

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
