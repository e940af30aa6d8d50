// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "hirosco/descriptor/read/detail/function_reader.hpp"

namespace hirosco::descriptor::detail {
namespace {

/// One word of a list, where it stands.
[[nodiscard]] xml::Attribute word_of(const xml::Attribute& list, std::string_view word) {
  xml::Attribute one = list;
  one.value = word;
  one.value_at.column += static_cast<int>(word.data() - list.value.data());
  return one;
}

void leaves(Function& function, std::uint16_t parameter) {
  const auto at = std::ranges::lower_bound(function.unrepeated, parameter);
  if (at == function.unrepeated.end() || *at != parameter) function.unrepeated.insert(at, parameter);
}

[[nodiscard]] bool has_one_value(const Field& field) {
  return field.minimum && field.maximum && *field.minimum == *field.maximum;
}

}  // namespace

void FunctionReader::read(const xml::Element& element, const Services& services) {
  Attributes attributes{element, problems_};
  Function function;
  function.at = place(element.at);
  function.name = attributes.name("name", NameKind::Function);
  function.essential = attributes.yes("essential", false);
  function.confirm = attributes.yes("confirm", false);
  function.states = read_states(attributes, "states", {State::Operational});
  read_sets(attributes, function);
  if (const auto* at = attributes.optional("id"); at != nullptr)
    problems_.not_built_in(*at, "leave it out: a function is called by its name");
  Unique names{"argument name", "E0201"};
  each_child(element, problems_,
             {{"Argument", [&](const xml::Element& child) { read_argument(child, function, names); }, max_arguments},
              {"Description",
               [&](const xml::Element& child) {
                 no_children(child, problems_, true);
                 function.description = child.text;
               },
               1}});
  check_arguments(element, function);
  expect_for_all(element, problems_, services, function.name);
  claim_name(element, function);
  subsystem_.functions.push_back(std::move(function));
}

/// One name, one request: whoever commands a subsystem by name need not know by which service it is carried.
void FunctionReader::claim_name(const xml::Element& element, const Function& function) {
  if (std::ranges::find(built_in_requests, function.name) != built_in_requests.end())
    problems_.add(*element.find("name"), "E0213",
                  fmt::format("'{}' is built in: every subsystem has it", function.name));
  else if (!function.name.empty()) function_names_.add(function.name, function.at, problems_, element.name.size() + 1);
}

void FunctionReader::check_arguments(const xml::Element& element, const Function& function) {
  std::size_t octets = 0;
  for (const Function::Argument& argument : function.arguments) octets += argument.octets();
  if (octets > max_argument_octets)
    problems_.add(element, "E0225", fmt::format("the arguments of function '{}' take {} octets", function.name, octets),
                  fmt::format("at most {} in one call", max_argument_octets));
}

void FunctionReader::read_argument(const xml::Element& element, Function& function, Unique& names) {
  Attributes attributes{element, problems_};
  Function::Argument argument;
  if (element.find("of") != nullptr) read_range_of(attributes, argument, function);
  else {
    argument.field = fields_.read(attributes, Says::Argument);
    const bool named = argument.field.type == Type::Bool || !argument.field.enumeration.empty();
    if (!named && argument.field.type != Type::Text) expect_range(element, problems_, "argument");
  }
  read_fallback(attributes, argument);
  no_children(element, problems_);
  if (!argument.field.name.empty())
    names.add(argument.field.name, place(element.at), problems_, element.name.size() + 1);
  function.arguments.push_back(std::move(argument));
}

void FunctionReader::read_fallback(Attributes& attributes, Function::Argument& argument) {
  const auto* at = attributes.optional("default");
  if (at == nullptr) return;
  Field each = argument.field;
  each.count = 1;
  if (auto values = read_values(problems_, *at, each.name, {&each, 1}, subsystem_.enumerations))
    argument.fallback = std::move(values->front());
}

/// One range for a number wherever it is set: the argument is one value of the parameter.
void FunctionReader::read_range_of(Attributes& attributes, Function::Argument& argument, Function& function) {
  const std::string name = attributes.name();
  const xml::Attribute& at = *attributes.optional("of");
  for (const std::string_view own : {"type", "count", "octets", "unit", "minimum", "maximum", "enumeration"})
    if (const auto* given = attributes.optional(own); given != nullptr)
      problems_.add(place(given->at), "E0220", fmt::format("'{}' has its {} from {}", name, own, in_quotes(at.value)),
                    fmt::format("leave {} or of out", own), own.size());
  if (const auto parameter = references_.resolve(at, fmt::format("argument '{}'", name))) {
    const auto fields = fields_of(subsystem_, *parameter);
    argument.of = at.value;
    if (fields.size() != 1)
      problems_.add(at, "E0221", in_quotes(at.value) + " is a structure", "name one of its members");
    else if (is_carried(fields.front().type) && (!fields.front().minimum || !fields.front().maximum))
      problems_.add(at, "E0221", in_quotes(at.value) + " has no range", "give it minimum and maximum");
    if (!fields.empty()) argument.field = fields.front();
    claim_parameter(*parameter, at, function);
    if (subsystem_.parameters[parameter->parameter].protection) leaves(function, parameter->parameter);
  }
  argument.field.name = name;
  argument.field.count = 1;
  argument.field.at = place(attributes.element().at);
}

/// Which of its arguments sets a parameter is said by `of`; what else it changes is known to its code alone.
void FunctionReader::read_sets(Attributes& attributes, Function& function) {
  const auto* at = attributes.optional("sets");
  if (at == nullptr) return;
  const auto listed = words(at->value);
  if (listed.empty()) problems_.add(*at, "E0109", "attribute 'sets' is empty");
  for (auto name = listed.begin(); name != listed.end(); ++name) {
    const xml::Attribute one = word_of(*at, *name);
    if (std::find(listed.begin(), name, *name) != name) {
      problems_.add(one, "E0113", in_quotes(*name) + " stands twice");
      continue;
    }
    const auto parameter = references_.resolve(one, fmt::format("'{}'", function.name));
    if (!parameter) continue;
    const std::string& from = subsystem_.parameters[parameter->parameter].from;
    if (!references_.is_own(*parameter) || !from.empty()) {
      problems_.add(one, "E0354",
                    from.empty() ? fmt::format("{} is the framework's, no function sets it", in_quotes(*name))
                                 : fmt::format("{} has the value of {}", in_quotes(*name), in_quotes(from)),
                    "name what the handler of the function stores");
      continue;
    }
    claim_parameter(*parameter, one, function);
    leaves(function, parameter->parameter);
  }
}

void FunctionReader::claim_parameter(const ParameterRef& parameter, const xml::Attribute& at,
                                     const Function& function) {
  set_.push_back(parameter);
  const Parameter& its = subsystem_.parameters[parameter.parameter];
  const std::string& setter = raised_by_.try_emplace(parameter.parameter, function.name).first->second;
  if (its.protection && setter != function.name)
    problems_.add(at, "E0219", fmt::format("'{}' is a protection and '{}' sets it already", its.field.name, setter),
                  "a protection is raised by one function only");
}

bool FunctionReader::is_set(const ParameterRef& value) const {
  const auto has = [&](const ParameterRef& set) { return covers(subsystem_, set, value); };
  return std::ranges::any_of(set_, has) ||
         std::ranges::any_of(subsystem_.configurations, [&](const Configuration& configuration) {
           return std::ranges::any_of(configuration.initial, has, &Configuration::Initial::parameter);
         });
}

/// Whoever wrote the range meant somebody to use it. A function that does so and does not say it is one whose limits would be
/// lost in a crash, and nobody would know. With other problems in the file its `sets` may be what was not read.
void FunctionReader::check_protections() {
  if (problems_.count() != 0) return;
  for (std::size_t i = 0; i < subsystem_.parameters.size(); ++i) {
    const Parameter& parameter = subsystem_.parameters[i];
    if (!parameter.protection) continue;
    const auto index = static_cast<std::uint16_t>(i);
    const auto is_open = [&](const Field& field, std::optional<std::uint16_t> member) {
      return !has_one_value(field) && !is_set({{}, index, member, {}});
    };
    std::string open;
    if (parameter.members.empty() && is_open(parameter.field, std::nullopt)) open = parameter.field.name;
    for (std::uint16_t m = 0; m < parameter.members.size() && open.empty(); ++m)
      if (const Field& field = parameter.members[m].field; is_open(field, m))
        open = parameter.field.name + "." + field.name;
    if (!open.empty())
      problems_.add(
          parameter.field.at, "E0355", fmt::format("'{}' is a protection of many values, and nobody sets it", open),
          "name it in the sets of the function that changes it; what nobody changes has minimum = maximum", 9);
  }
}

}  // namespace hirosco::descriptor::detail
