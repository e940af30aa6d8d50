// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "hirosco/descriptor/read/detail/mission_parts.hpp"

namespace hirosco::descriptor::detail {
namespace {

void read_shown(const xml::Element& element, MissionDraft& draft) {
  Attributes attributes{element, draft.problems};
  no_children(element, draft.problems);
  ShownValue shown;
  shown.decimals = attributes.integer_or<std::uint8_t>("decimals", 0, 9, 3);
  if (const auto* label = attributes.required("label")) shown.label = label->value;
  const auto* whose = attributes.required("subsystem");
  const auto* wanted = attributes.required("parameter");
  const SubsystemDescriptor* owner = whose == nullptr ? nullptr : draft.find(*whose, whose->value, true);
  if (owner == nullptr || wanted == nullptr) return;
  std::vector<std::string> names;
  for (const Parameter& parameter : owner->parameters) {
    const auto take = [&](std::string name, const Field& field) {
      if (name == wanted->value) shown.unit = field.unit;
      names.push_back(std::move(name));
    };
    if (parameter.members.empty()) take(parameter.field.name, parameter.field);
    for (const auto& member : parameter.members) take(parameter.field.name + "." + member.field.name, member.field);
  }
  if (std::ranges::find(names, wanted->value) == names.end()) {
    const std::vector<std::string_view> known{names.begin(), names.end()};
    draft.problems.add(*wanted, "E0327", fmt::format("'{}' has no parameter {}", owner->name, in_quotes(wanted->value)),
                       did_you_mean(wanted->value, known));
    return;
  }
  shown.parameter = owner->name + "." + wanted->value;
  draft.mission.console.push_back(std::move(shown));
}

}  // namespace

void read_console(const xml::Element& element, MissionDraft& draft) {
  const Attributes none{element, draft.problems};
  each_child(element, draft.problems, {{"Show", [&](const auto& child) { read_shown(child, draft); }, 16}});
}

}  // namespace hirosco::descriptor::detail
