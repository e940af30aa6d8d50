// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "hirosco/descriptor/read/detail/mission_reader.hpp"

namespace hirosco::descriptor::detail {

void MissionReader::read_console(const xml::Element& element) {
  const Attributes none{element, problems_};
  each_child(element, problems_, {{"Show", [this](const auto& child) { read_shown(child); }, 16}});
}

void MissionReader::read_shown(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  ShownValue shown;
  shown.decimals = attributes.integer_or<std::uint8_t>("decimals", 0, 9, 3);
  if (const auto* label = attributes.required("label")) shown.label = label->value;
  const auto* whose = attributes.required("subsystem");
  const auto* wanted = attributes.required("parameter");
  const SubsystemDescriptor* owner = whose == nullptr ? nullptr : find(*whose, whose->value, true);
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
    problems_.add(*wanted, "E0327", fmt::format("'{}' has no parameter {}", owner->name, in_quotes(wanted->value)),
                  did_you_mean(wanted->value, known));
    return;
  }
  shown.parameter = owner->name + "." + wanted->value;
  mission_.console.push_back(std::move(shown));
}

}  // namespace hirosco::descriptor::detail
