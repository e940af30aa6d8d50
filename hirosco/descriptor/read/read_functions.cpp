// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/read/detail/function_reader.hpp"

namespace hirosco::descriptor::detail {

void FunctionReader::read(const xml::Element& element, const Services& services) {
  Attributes attributes{element, problems_};
  Function function;
  function.at = place(element.at);
  function.name = attributes.name("name", NameKind::Function);
  function.essential = attributes.yes("essential", false);
  function.confirm = attributes.yes("confirm", false);
  function.states = read_states(attributes, "states", {State::Operational});
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
  if (element.find("of") != nullptr) read_range_of(attributes, argument, function.name);
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
void FunctionReader::read_range_of(Attributes& attributes, Function::Argument& argument, const std::string& function) {
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
    const Parameter& of = subsystem_.parameters[parameter->parameter];
    const std::string& setter = raised_by_.try_emplace(parameter->parameter, function).first->second;
    if (of.protection && setter != function)
      problems_.add(at, "E0219", fmt::format("'{}' is a protection and '{}' sets it already", of.field.name, setter),
                    "a protection is raised by one function only");
  }
  argument.field.name = name;
  argument.field.count = 1;
  argument.field.at = place(attributes.element().at);
}

}  // namespace hirosco::descriptor::detail
