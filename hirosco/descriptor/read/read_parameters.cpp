// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "hirosco/descriptor/read/detail/parameter_reader.hpp"

namespace hirosco::descriptor::detail {

bool BuiltInParameters::read(const xml::Element& element) {
  const auto* name = element.find("name");
  if (name == nullptr) return false;
  const auto found =
      std::ranges::find_if(built_in_, [&](const Parameter& parameter) { return parameter.field.name == name->value; });
  const bool states = element.name == "Enumeration" && name->value == states_enumeration;
  if (element.name == "Enumeration" ? !states : found == built_in_.end()) return false;
  if (element.name != "StructRef" || !element.children.empty()) {
    problems_.add(
        element, "E0213", fmt::format("{} is built in: every subsystem has it", in_quotes(name->value)),
        states ? "leave it out, and refer to it all the same"
               : "leave it out, and refer to it all the same; a <StructRef> without members gives it another id");
    return true;
  }
  Attributes attributes{element, problems_};
  static_cast<void>(attributes.name());
  found->id = attributes.required_integer<std::uint8_t>("id", 0, 255);
  found->field.at = place(element.at);
  no_children(element, problems_);
  return true;
}

void BuiltInParameters::imply_outputs() {
  std::size_t actuators = 0;
  std::map<Type, std::size_t> fields;
  for (const Device& device : subsystem_.devices) {
    if (!device.actuator) continue;
    bool too_many = ++actuators > most_actuators;
    for (const Device::Output& output : device.output) too_many |= ++fields[output.field.type] > most_output_fields;
    if (!too_many) continue;
    return problems_.add(device.at, "E0232", fmt::format("no ids are left for the outputs of '{}'", device.name),
                         fmt::format("a subsystem has at most {} actuators, with {} output fields of one type",
                                     most_actuators, most_output_fields),
                         6);
  }
  std::ranges::move(output_parameters(subsystem_.devices), std::back_inserter(built_in_));
}

/// No identity of the author's is one of theirs.
void BuiltInParameters::imply_parameters() {
  for (const Parameter& built_in : built_in_) {
    for (const Parameter& parameter : subsystem_.parameters) {
      check_built_in_ids(built_in, parameter.field, parameter.id);
      for (const Parameter::Member& member : parameter.members) check_built_in_ids(built_in, member.field, member.id);
    }
    // One that has its id from the descriptor may have taken another's.
    for (const Parameter& other : built_in_)
      if (&other != &built_in && other.field.at.line != 0) check_built_in_ids(built_in, other.field, other.id);
  }
  std::ranges::copy(built_in_, std::back_inserter(subsystem_.parameters));
}

void BuiltInParameters::check_built_in_ids(const Parameter& built_in, const Field& field, std::uint8_t id) {
  const bool member = std::ranges::any_of(
      built_in.members, [&](const auto& theirs) { return theirs.field.type == field.type && theirs.id == id; });
  if (!member && (field.type != Type::Struct || built_in.id != id)) return;
  const bool of_all = std::ranges::any_of(
      framework_parameters(), [&](const Parameter& parameter) { return parameter.field.name == built_in.field.name; });
  problems_.add(field.at, "E0203",
                fmt::format("type and id of '{}', {} {}, are those of '{}', which every subsystem{} has", field.name,
                            to_text(field.type), id, built_in.field.name, of_all ? "" : " with this actuator"),
                "type and id together must be unique, members included");
}

void ParameterReader::read(const xml::Element& element) {
  if (element.name == "StructRef") return read_structure(element);
  if (element.name == "ParamRef") return read_parameter(element);
  const Attributes none{element, problems_};
  each_child(element, problems_,
             {{"StructRef", [this](const auto& child) { read_structure(child); }},
              {"ParamRef", [this](const auto& child) { read_parameter(child); }}});
}

void ParameterReader::read_enumeration(const xml::Element& element) {
  if (built_in_.read(element)) return;
  Attributes attributes{element, problems_};
  Enumeration enumeration{attributes.name(), {}};
  if (!enumeration.name.empty())
    enumeration_names_.add(enumeration.name, place(element.at), problems_, element.name.size() + 1);
  Unique values{"enumeration value", "E0202"};
  each_child(element, problems_,
             {{"Text", [&](const xml::Element& text) {
                 Attributes inner{text, problems_};
                 const auto value = inner.required_integer<std::int64_t>(
                     "value", std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max());
                 no_children(text, problems_, true);
                 if (inner.element().find("value") != nullptr)
                   values.add(std::to_string(value), place(text.at), problems_, text.name.size() + 1);
                 if (words(text.text).empty()) problems_.add(text, "E0109", "<Text> is empty");
                 enumeration.texts.push_back({value, text.text});
               }}});
  if (enumeration.texts.empty()) problems_.add(element, "E0106", "<Enumeration> needs at least one <Text>");
  subsystem_.enumerations.push_back(std::move(enumeration));
}

void ParameterReader::read_parameter(const xml::Element& element) {
  if (built_in_.read(element)) return;
  Attributes attributes{element, problems_};
  Parameter parameter;
  parameter.field = fields_.read(attributes, Says::WordsAndRange);
  parameter.id = attributes.required_integer<std::uint8_t>("id", 0, 255);
  if (const auto* init = attributes.optional("init"); init != nullptr)
    initial_values_.push_back({subsystem_.parameters.size(), std::nullopt, init});
  read_access(attributes, parameter);
  read_persistent(attributes, parameter);
  read_from(attributes, parameter);
  claim_parameter_id(attributes, parameter.field.type, parameter.id, parameter_ids_, problems_);
  no_children(element, problems_);
  if (parameter.writable()) expect_range(element, problems_, "parameter");
  const Number zero{0};
  const bool zero_outside =
      parameter.field.minimum.value_or(zero) > zero || parameter.field.maximum.value_or(zero) < zero;
  if (zero_outside && element.find("init") == nullptr)
    problems_.add(
        element, "E0207",
        fmt::format("'{}' begins as 0, outside its range {}", parameter.field.name, range_text(parameter.field)),
        "add the attribute init");
  if (!parameter.field.name.empty())
    parameter_names_.add(parameter.field.name, place(element.at), problems_, element.name.size() + 1);
  subsystem_.parameters.push_back(std::move(parameter));
}

/// Once all enumerations are known, whose names they may be given by.
void ParameterReader::read_initial_values() {
  for (const auto& [index, member, at] : initial_values_) {
    Parameter& parameter = subsystem_.parameters[index];
    const auto fields = fields_of(subsystem_, {{}, static_cast<std::uint16_t>(index), member, {}});
    auto values = read_values(problems_, *at, fields.front().name, fields, subsystem_.enumerations);
    if (values) begin_with(parameter, member, std::move(*values));
  }
}

void ParameterReader::read_access(Attributes& attributes, Parameter& parameter) {
  if (const auto* at = attributes.optional("read_only"); at != nullptr)
    problems_.not_built_in(*at, "leave it out: a parameter is read-only in every state that 'writable' does not name");
  parameter.protection = attributes.yes("protection", false);
  parameter.writable_states = read_states(attributes, "writable", {});
  const auto* writable = attributes.optional("writable");
  if (writable != nullptr && parameter.protection)
    problems_.add(*writable, "E0219", fmt::format("'{}' is a protection and writable", parameter.field.name),
                  "a protection is raised by its own function only");
}

/// After read_access: nothing that protects less, or moves something, comes back by itself.
void ParameterReader::read_persistent(Attributes& attributes, Parameter& parameter) {
  parameter.persistent = attributes.yes("persistent", false);
  if (!parameter.persistent) return;
  const auto& at = *attributes.optional("persistent");
  const std::string& name = parameter.field.name;
  const bool before_it_moves =
      parameter.writable_in(State::PreOperational) || parameter.writable_in(State::SafeOperational);
  if (parameter.protection)
    problems_.add(at, "E0236", fmt::format("'{}' is a protection and persistent", name),
                  "what a function has loosened begins as the descriptor says");
  else if (!before_it_moves)
    problems_.add(at, "E0237",
                  fmt::format("'{}' is persistent and writable neither in PreOperational nor in SafeOperational", name),
                  "what is set only while something may move does not come back by itself");
  if (persistent_octets_ <= max_persistent_octets &&
      (persistent_octets_ += parameter.octets() + sizeof(std::uint32_t)) > max_persistent_octets)
    problems_.add(at, "E0239", fmt::format("with '{}' persistent parameters take {} octets", name, persistent_octets_),
                  fmt::format("{} at most, each with 4 for its id", max_persistent_octets));
}

void claim_parameter_id(Attributes& attributes, Type type, std::uint8_t id, Unique& ids, Problems& problems) {
  const xml::Element& element = attributes.element();
  const xml::Attribute* written = element.find("id");
  const bool known_type =
      type == Type::Struct || (element.find("type") != nullptr && from_text<Type>(element.find("type")->value));
  if (written == nullptr || !known_type || to_integer(written->value) != id) return;
  ids.add(fmt::format("{} {}", to_text(type), id), place(written->value_at), problems, written->value.size(),
          "type and id together must be unique, members included");
}

}  // namespace hirosco::descriptor::detail
