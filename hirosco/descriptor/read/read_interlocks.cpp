// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "hirosco/descriptor/read/detail/mission_reader.hpp"

/// What has to hold before a mode is entered (docs/adr/0075).
namespace hirosco::descriptor::detail {

void MissionReader::read_interlock(const xml::Element& element, Interlock::Kind kind, Mode& mode) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  Interlock interlock{.kind = kind, .subsystem = {}, .states = {}, .configuration = {}, .at = place(element.at)};
  const auto* subsystem = attributes.required("subsystem");
  const auto* state = attributes.required("state");
  const auto* configuration = attributes.optional("configuration");
  interlock.states = attributes.list_of<State>("state", {});
  for (const State one : interlock.states)
    if (!is_steady(one))
      problems_.add(*state, "E0306", fmt::format("{} is passed through: nobody is found in it", to_text(one)),
                    "Offline, PreOperational, SafeOperational, Operational, ErrorOperational or PostOperational");
  if (subsystem == nullptr || state == nullptr) return;
  interlock.subsystem = subsystem->value;
  const SubsystemDescriptor* found = find(*subsystem, interlock.subsystem, false);
  if (configuration != nullptr) interlock.configuration = configuration->value;
  if (found != nullptr && configuration != nullptr && found->find_configuration(interlock.configuration) == nullptr) {
    std::vector<std::string_view> known;
    for (const Configuration& candidate : found->configurations) known.push_back(candidate.name);
    problems_.add(*configuration, "E0316",
                  fmt::format("'{}' has no configuration {}", found->name, in_quotes(interlock.configuration)),
                  did_you_mean(interlock.configuration, known));
  }
  if (found != nullptr) mode.interlocks.push_back(std::move(interlock));
}

void MissionReader::check_from(const xml::Element& modes) {
  std::vector<std::string_view> known;
  for (const Mode& candidate : mission_.modes) known.push_back(candidate.name);
  for (const xml::Element& element : modes.children) {
    const auto* at = element.find("from");
    if (at == nullptr) continue;
    if (words(at->value).empty()) problems_.add(*at, "E0109", "attribute 'from' is empty");
    for (const auto word : words(at->value))
      if (mission_.find_mode(word) == nullptr)
        problems_.add(*at, "E0305", fmt::format("mode {} is not defined", in_quotes(word)), did_you_mean(word, known));
  }
}

void MissionReader::check_start(const xml::Attribute& start, const Mode& mode) {
  for (const std::string& why : against_start(mission_, mode))
    problems_.add(start, "E0330", fmt::format("mode {} cannot be the first: {}", in_quotes(mode.name), why),
                  "commissioning begins in the initial mode, with every subsystem Offline");
}

}  // namespace hirosco::descriptor::detail
