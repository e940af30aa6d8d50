// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <utility>

#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"
#include "hirosco/parameter/text.hpp"

namespace hirosco::descriptor::detail {
namespace {

constexpr std::int64_t max_count = 4096;
constexpr std::int64_t max_lent_count = max_loaned_payload_octets;

}  // namespace

bool SubsystemReader::read_built_in(const xml::Element& element) {
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

void SubsystemReader::read_parameter_element(const xml::Element& element) {
  if (element.name == "StructRef") return read_structure(element);
  if (element.name == "ParamRef") return read_parameter(element);
  const Attributes none{element, problems_};
  each_child(element, problems_,
             {{"StructRef", [this](const auto& child) { read_structure(child); }},
              {"ParamRef", [this](const auto& child) { read_parameter(child); }}});
}

void SubsystemReader::imply_outputs() {
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
void SubsystemReader::imply_parameters() {
  const std::size_t own = subsystem_.parameters.size();
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
  index_references(own);
}

void SubsystemReader::check_built_in_ids(const Parameter& built_in, const Field& field, std::uint8_t id) {
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

void SubsystemReader::read_enumeration(const xml::Element& element) {
  if (read_built_in(element)) return;
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

void SubsystemReader::read_parameter(const xml::Element& element) {
  if (read_built_in(element)) return;
  Attributes attributes{element, problems_};
  Parameter parameter;
  parameter.field = read_field(attributes, Says::WordsAndRange);
  parameter.id = attributes.required_integer<std::uint8_t>("id", 0, 255);
  if (const auto* init = attributes.optional("init"); init != nullptr)
    initial_values_.push_back({subsystem_.parameters.size(), std::nullopt, init});
  read_access(attributes, parameter);
  read_persistent(attributes, parameter);
  read_from(attributes, parameter);
  claim_parameter_id(attributes, parameter.field.type, parameter.id);
  no_children(element, problems_);
  if (parameter.writable()) expect_range(element, "parameter");
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
void SubsystemReader::read_initial_values() {
  for (const auto& [index, member, at] : initial_values_) {
    Parameter& parameter = subsystem_.parameters[index];
    const auto fields = fields_of(subsystem_, {{}, static_cast<std::uint16_t>(index), member, {}});
    auto values = read_values(problems_, *at, fields.front().name, fields, subsystem_.enumerations);
    if (values) begin_with(parameter, member, std::move(*values));
  }
}

void SubsystemReader::expect_range(const xml::Element& element, std::string_view what) {
  // A switch has its two values, a text its octets.
  if (const auto* type = element.find("type"); type != nullptr && (type->value == "BOOL" || type->value == "TEXT"))
    return;
  std::string missing;
  for (const std::string_view limit : {"minimum", "maximum"})
    if (element.find(limit) == nullptr) missing += fmt::format("{}{}", missing.empty() ? "" : " and ", limit);
  if (missing.empty()) return;
  const auto* name = element.find("name");
  problems_.add(element, "E0228",
                fmt::format("{} {} can be set from outside and has no {}", what,
                            in_quotes(name == nullptr ? std::string_view{} : name->value), missing),
                "say what it may be, with minimum and maximum");
}

void SubsystemReader::read_access(Attributes& attributes, Parameter& parameter) {
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
void SubsystemReader::read_persistent(Attributes& attributes, Parameter& parameter) {
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

void SubsystemReader::claim_parameter_id(Attributes& attributes, Type type, std::uint8_t id) {
  const xml::Element& element = attributes.element();
  const xml::Attribute* written = element.find("id");
  const bool known_type =
      type == Type::Struct || (element.find("type") != nullptr && from_text<Type>(element.find("type")->value));
  if (written == nullptr || !known_type || to_integer(written->value) != id) return;
  parameter_ids_.add(fmt::format("{} {}", to_text(type), id), place(written->value_at), problems_,
                     written->value.size(), "type and id together must be unique, members included");
}

Field SubsystemReader::read_field(Attributes& attributes, Says says, NameKind kind) {
  Field field;
  field.at = place(attributes.element().at);
  field.name = attributes.name("name", kind);
  if (const auto* type = attributes.required("type"); type != nullptr) {
    field.type = attributes.one_of("type", Type::Double);
    const bool numbers_only = says == Says::Nothing || says == Says::Words || says == Says::Range || says == Says::Lent;
    if (field.type == Type::Struct) {
      problems_.add(*type, "E0104", fmt::format("'{}' is a type of <StructRef> only", type->value));
      field.type = Type::Double;
    } else if (!is_carried(field.type) && numbers_only) {
      problems_.add(*type, "E0104",
                    fmt::format("'{}' is a type of parameters, of a function's arguments and of an own service only",
                                type->value),
                    "real-time links, devices and events carry numbers: a switch as UINT8");
      field.type = Type::Double;
    }
  }
  if (field.type == Type::Text) {
    static_assert(max_text_octets + sizeof(std::uint16_t) == max_argument_octets);
    field.text_octets = attributes.required_integer<std::uint16_t>("octets", 1, max_text_octets);
    return field;
  }
  field.count = attributes.integer_or<std::uint32_t>("count", 1, says == Says::Lent ? max_lent_count : max_count, 1);
  if (field.type == Type::Bool) return field;
  field.unit = attributes.text("unit");
  if (field.unit.size() > 32)
    problems_.add(*attributes.element().find("unit"), "E0114", "a unit has at most 32 octets");
  const bool all = says == Says::WordsAndRange || says == Says::Argument;
  if (all || says == Says::Words || says == Says::Report) read_words(attributes, field);
  if (all || says == Says::Range) check_field_range(attributes, field);
  return field;
}

void SubsystemReader::read_words(Attributes& attributes, Field& field) {
  const auto* use = attributes.optional("enumeration");
  if (use == nullptr) return;
  field.enumeration = use->value;
  enumeration_uses_.push_back({use, use->value, field.type});
}

void SubsystemReader::check_field_range(Attributes& attributes, Field& field) {
  const auto limit = [&](std::string_view name) {
    const auto value = attributes.exact(name);
    if (!value) return value;
    const bool fits = check_value(problems_, *attributes.element().find(name), field, *value);
    return fits ? value : std::nullopt;
  };
  const auto minimum = limit("minimum");
  const auto maximum = limit("maximum");
  field.minimum = minimum;
  field.maximum = maximum;
  if (!minimum || !maximum || *minimum <= *maximum) return;
  problems_.add(*attributes.element().find("minimum"), "E0206",
                fmt::format("minimum {} is above maximum {}", to_string(*minimum), to_string(*maximum)));
  field.minimum = field.maximum = std::nullopt;
}

void SubsystemReader::read_plain_field(const xml::Element& element, std::vector<Field>& fields, Unique& names,
                                       Says says, NameKind kind) {
  Attributes attributes{element, problems_};
  Field field = read_field(attributes, says, kind);
  no_children(element, problems_);
  if (!field.name.empty()) names.add(field.name, place(element.at), problems_, element.name.size() + 1);
  fields.push_back(std::move(field));
}

void SubsystemReader::check_enumerations() {
  std::vector<std::string_view> known;
  for (const Enumeration& enumeration : subsystem_.enumerations) known.push_back(enumeration.name);
  std::ranges::sort(known);
  for (const EnumerationUse& use : enumeration_uses_) {
    if (problems_.full()) return;
    if (!std::ranges::binary_search(known, use.name))
      problems_.add(*use.at, "E0210", fmt::format("enumeration {} is not defined", in_quotes(use.name)),
                    did_you_mean(use.name, known));
    else if (!is_integer(use.type))
      problems_.add(*use.at, "E0208", fmt::format("an enumeration needs an integer type, not {}", to_text(use.type)));
  }
  for (Function& function : subsystem_.functions) name_values(function.arguments);
  for (CustomService& service : subsystem_.services) {
    for (Function& request : service.requests) name_values(request.arguments);
    for (CustomService::Report& report : service.reports) name_values(report.fields);
  }
}

void SubsystemReader::name_values(std::vector<Function::Argument>& arguments) {
  for (Function::Argument& argument : arguments) {
    if (argument.field.type == Type::Bool)
      argument.texts = {{0, std::string{switch_word(false)}}, {1, std::string{switch_word(true)}}};
    const auto found = std::ranges::find(subsystem_.enumerations, argument.field.enumeration, &Enumeration::name);
    if (argument.field.enumeration.empty() || found == subsystem_.enumerations.end()) continue;
    argument.texts = found->texts;
    const TypeRange range = range_of(argument.field.type);
    for (const EnumerationText& text : argument.texts)
      if (Number{text.value} < range.lowest || Number{text.value} > range.highest)
        problems_.add(argument.field.at, "E0208",
                      fmt::format("{} of enumeration '{}' does not fit {}", text.value, found->name,
                                  to_text(argument.field.type)));
    if (argument.fallback && std::ranges::none_of(argument.texts, [&](const EnumerationText& text) {
          return *argument.fallback == Value{Number{text.value}};
        }))
      problems_.add(
          argument.field.at, "E0207",
          fmt::format("the default of '{}' is no value of enumeration '{}'", argument.field.name, found->name));
  }
}

std::optional<ParameterRef> SubsystemReader::read_reference(Attributes& attributes, std::string_view user) {
  const auto* name = attributes.required("name");
  return name == nullptr ? std::nullopt : resolve(*name, user);
}

/// A parameter's own name goes before members of that name: it is listed first, and is not ambiguous.
void SubsystemReader::index_references(std::size_t own) {
  const auto add = [this](const std::string& text, std::size_t parameter, std::optional<std::uint16_t> member) {
    references_[text].push_back({text, static_cast<std::uint16_t>(parameter), member, {}});
  };
  const auto& parameters = subsystem_.parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) add(parameters[i].field.name, i, std::nullopt);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    for (std::uint16_t m = 0; m < parameters[i].numbers(); ++m) {
      const std::string member{parameters[i].identity_of(m).name};
      if (i < own) add(member, i, m);
      add(parameters[i].field.name + "." + member, i, m);
    }
}

std::optional<ParameterRef> SubsystemReader::resolve(const xml::Attribute& name, std::string_view user) {
  const std::string_view text = name.value;
  const auto found = text.empty() ? references_.end() : references_.find(text);
  if (found == references_.end()) {
    problems_.add(name, "E0204", fmt::format("{} refers to {}, which is not defined", user, in_quotes(text)),
                  suggest_reference(text));
    return std::nullopt;
  }
  const std::vector<ParameterRef>& members = found->second;
  if (members.size() == 1 || !members.front().member) {
    ParameterRef reference = members.front();
    reference.at = place(name.value_at);
    return reference;
  }
  std::string hint = "one of";
  for (std::size_t i = 0; i < members.size() && i < 8; ++i)
    hint += fmt::format(" '{}.{}'", subsystem_.parameters[members[i].parameter].field.name, text);
  problems_.add(name, "E0205", fmt::format("{} refers to {}, a member of several structures", user, in_quotes(text)),
                hint);
  return std::nullopt;
}

std::string SubsystemReader::suggest_reference(std::string_view text) const {
  std::vector<std::string_view> names;
  for (const auto& [name, references] : references_) names.push_back(name);
  std::string hint = did_you_mean(text, names);
  const std::size_t first = hint.find('\''), last = hint.rfind('\'');
  if (hint.empty() || first == last) return hint;
  const ParameterRef& nearest = references_.find(hint.substr(first + 1, last - first - 1))->second.front();
  const Parameter& parameter = subsystem_.parameters[nearest.parameter];
  const Field& field = nearest.member ? parameter.members_at(nearest.member).front().field : parameter.field;
  return hint + fmt::format(" (line {})", field.at.line);
}

std::size_t SubsystemReader::octets_of_reference(const ParameterRef& reference) const {
  const Parameter& parameter = subsystem_.parameters[reference.parameter];
  return parameter.octets(reference.member);
}

}  // namespace hirosco::descriptor::detail
