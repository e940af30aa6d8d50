// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "hirosco/descriptor/read/detail/mode_parts.hpp"

/// What has to hold before a mode is entered (docs/adr/0075).
namespace hirosco::descriptor::detail {

void read_interlock(const xml::Element& element, Interlock::Kind kind, Mode& mode, MissionDraft& draft) {
  Attributes attributes{element, draft.problems};
  no_children(element, draft.problems);
  Interlock interlock{.kind = kind, .subsystem = {}, .states = {}, .configuration = {}, .at = place(element.at)};
  const auto* subsystem = attributes.required("subsystem");
  const auto* state = attributes.required("state");
  const auto* configuration = attributes.optional("configuration");
  interlock.states = attributes.list_of<State>("state", {});
  for (const State one : interlock.states)
    if (!is_steady(one))
      draft.problems.add(*state, "E0306", fmt::format("{} is passed through: nobody is found in it", to_text(one)),
                         "Offline, PreOperational, SafeOperational, Operational, ErrorOperational or PostOperational");
  if (subsystem == nullptr || state == nullptr) return;
  interlock.subsystem = subsystem->value;
  const SubsystemDescriptor* found = draft.find(*subsystem, interlock.subsystem, false);
  if (configuration != nullptr) interlock.configuration = configuration->value;
  if (found != nullptr && configuration != nullptr && found->find_configuration(interlock.configuration) == nullptr) {
    std::vector<std::string_view> known;
    for (const Configuration& candidate : found->configurations) known.push_back(candidate.name);
    draft.problems.add(*configuration, "E0316",
                       fmt::format("'{}' has no configuration {}", found->name, in_quotes(interlock.configuration)),
                       did_you_mean(interlock.configuration, known));
  }
  if (found != nullptr) mode.interlocks.push_back(std::move(interlock));
}

}  // namespace hirosco::descriptor::detail
