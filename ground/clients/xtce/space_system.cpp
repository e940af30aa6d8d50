// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/xtce/space_system.hpp"

namespace hirosco::ground {
namespace {

void describe(Element& element, std::string_view says) {
  if (!says.empty())
    element.children.insert(element.children.begin(), {.name = "LongDescription", .text = std::string{says}});
}

[[nodiscard]] Element comparison(const Condition& condition) {
  return {"Comparison",
          {{"parameterRef", condition.parameter},
           {"comparisonOperator", condition.comparison},
           {"value", condition.value},
           {"useCalibratedValue", "false"}}};
}

[[nodiscard]] Element checked(const Condition& condition) {
  return {"Condition",
          {},
          {{"ParameterInstanceRef", {{"parameterRef", condition.parameter}, {"useCalibratedValue", "false"}}},
           {.name = "ComparisonOperator", .text = condition.comparison},
           {.name = "Value", .text = condition.value}}};
}

[[nodiscard]] Element restriction(const Container& container) {
  if (container.or_when.empty()) {
    Element list{"ComparisonList"};
    for (const auto& condition : container.when) list.children.push_back(comparison(condition));
    return list;
  }
  Element either{"ORedConditions"};
  for (const auto& condition : container.or_when) either.children.push_back(checked(condition));
  if (container.when.empty()) return {"BooleanExpression", {}, {std::move(either)}};
  Element all{"ANDedConditions"};
  for (const auto& condition : container.when) all.children.push_back(checked(condition));
  all.children.push_back(std::move(either));
  return {"BooleanExpression", {}, {std::move(all)}};
}

[[nodiscard]] Element repeated(const std::string& container, Element count) {
  return {
      "ContainerRefEntry", {{"containerRef", container}}, {{"RepeatEntry", {}, {{"Count", {}, {std::move(count)}}}}}};
}

}  // namespace

SpaceSystem::SpaceSystem(std::string_view name, std::string_view parent, std::string_view says)
    : name_{name}, path_{std::string{parent} + "/" + std::string{name}}, says_{says} {}

SpaceSystem& SpaceSystem::add_system(std::string_view name, std::string_view says) {
  return systems_.emplace_back(names_.unique(name), path_, says);
}

std::string SpaceSystem::add_parameter(std::string_view name, const std::string& type, std::string_view says,
                                       std::string_view id) {
  const std::string free = names_.unique(name);
  Element parameter{"Parameter", {{"name", free}, {"parameterTypeRef", type}}};
  if (!id.empty())
    parameter.children.push_back({"AliasSet", {}, {{"Alias", {{"nameSpace", wire_ids}, {"alias", std::string{id}}}}}});
  describe(parameter, says);
  parameters_.push_back(std::move(parameter));
  return path_ + "/" + free;
}

std::string SpaceSystem::add_container(const Container& container) {
  const std::string free = container_names_.unique(container.name);
  Element made{"SequenceContainer", {{"name", free}}};
  if (container.abstract) made.attributes.emplace_back("abstract", "true");
  if (container.partition)
    made.children.push_back(
        {"AncillaryDataSet",
         {},
         {{.name = "AncillaryData", .attributes = {{"name", "Yamcs"}}, .text = "UseAsArchivingPartition"}}});
  made.children.push_back({"EntryList", {}, container.entries});
  if (!container.base.empty()) {
    Element base{"BaseContainer", {{"containerRef", container.base}}};
    if (!container.when.empty() || !container.or_when.empty())
      base.children.push_back({"RestrictionCriteria", {}, {restriction(container)}});
    made.children.push_back(std::move(base));
  }
  describe(made, container.says);
  containers_.push_back(std::move(made));
  return path_ + "/" + free;
}

std::string SpaceSystem::add_command(std::string_view name, Element command) {
  command.attributes.insert(command.attributes.begin(), {"name", std::string{name}});
  commands_.push_back(std::move(command));
  return path_ + "/" + std::string{name};
}

Element SpaceSystem::element(std::vector<Element> parameter_types, std::vector<Element> argument_types,
                             std::vector<Element> header) const {
  Element system{"SpaceSystem", {{"name", name_}}, std::move(header)};
  Element telemetry{"TelemetryMetaData"};
  if (!parameter_types.empty()) telemetry.children.push_back({"ParameterTypeSet", {}, std::move(parameter_types)});
  if (!parameters_.empty()) telemetry.children.push_back({"ParameterSet", {}, parameters_});
  if (!containers_.empty()) telemetry.children.push_back({"ContainerSet", {}, containers_});
  if (!telemetry.children.empty()) system.children.push_back(std::move(telemetry));
  if (!commands_.empty()) {
    Element commanding{"CommandMetaData"};
    if (!argument_types.empty()) commanding.children.push_back({"ArgumentTypeSet", {}, std::move(argument_types)});
    commanding.children.push_back({"MetaCommandSet", {}, commands_});
    system.children.push_back(std::move(commanding));
  }
  for (const SpaceSystem& child : systems_) system.children.push_back(child.element());
  describe(system, says_);
  return system;
}

Element entry_of(const std::string& parameter) { return {"ParameterRefEntry", {{"parameterRef", parameter}}}; }

Element entry_at(const std::string& parameter, unsigned bit) {
  Element entry = entry_of(parameter);
  entry.children.push_back({"LocationInContainerInBits",
                            {{"referenceLocation", "containerStart"}},
                            {{.name = "FixedValue", .text = std::to_string(bit)}}});
  return entry;
}

Element included(const std::string& container) { return {"ContainerRefEntry", {{"containerRef", container}}}; }

Element included_times(const std::string& container, std::uint32_t times) {
  return repeated(container, {.name = "FixedValue", .text = std::to_string(times)});
}

Element included_by(const std::string& container, const std::string& parameter) {
  return repeated(container, {"DynamicValue", {}, {{"ParameterInstanceRef", {{"parameterRef", parameter}}}}});
}

}  // namespace hirosco::ground
