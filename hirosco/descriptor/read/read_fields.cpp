// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "hirosco/descriptor/model/framework_parameters.hpp"
#include "hirosco/descriptor/read/detail/field_reader.hpp"
#include "hirosco/parameter/text.hpp"

namespace hirosco::descriptor::detail {
namespace {

constexpr std::int64_t max_count = 4096;
constexpr std::int64_t max_lent_count = max_loaned_payload_octets;

void collect_named(const xml::Element& element, std::set<std::string_view>& names) {
  if (const auto* use = element.find("enumeration"); use != nullptr) names.insert(use->value);
  for (const xml::Element& child : element.children) collect_named(child, names);
}

}  // namespace

void check_enumerations_named(const xml::Element& root, Problems& problems) {
  std::set<std::string_view> named;
  collect_named(root, named);
  for (const xml::Element& element : root.children) {
    const auto* name = element.name == "Enumeration" ? element.find("name") : nullptr;
    // Of the built-in one it is told that it is.
    if (name == nullptr || name->value == states_enumeration || named.contains(name->value)) continue;
    problems.add(*name, "E0258", fmt::format("nothing has values of enumeration {}", in_quotes(name->value)),
                 "name it in the enumeration of a parameter, argument or field, or leave it out");
  }
}

void expect_range(const xml::Element& element, Problems& problems, std::string_view what) {
  // A switch has its two values, a text its octets.
  if (const auto* type = element.find("type"); type != nullptr && (type->value == "BOOL" || type->value == "TEXT"))
    return;
  std::string missing;
  for (const std::string_view limit : {"minimum", "maximum"})
    if (element.find(limit) == nullptr) missing += fmt::format("{}{}", missing.empty() ? "" : " and ", limit);
  if (missing.empty()) return;
  const auto* name = element.find("name");
  problems.add(element, "E0228",
               fmt::format("{} {} can be set from outside and has no {}", what,
                           in_quotes(name == nullptr ? std::string_view{} : name->value), missing),
               "say what it may be, with minimum and maximum");
}

Field FieldReader::read(Attributes& attributes, Says says, NameKind kind) {
  Field field;
  field.at = place(attributes.element().at);
  field.name = attributes.name("name", kind);
  if (const auto* type = attributes.required("type"); type != nullptr) {
    field.type = attributes.one_of("type", Type::Double);
    const bool told = says == Says::Told && field.type == Type::Text;
    const bool numbers_only = says == Says::Nothing || says == Says::Told || says == Says::Range || says == Says::Lent;
    if (field.type == Type::Struct) {
      problems_.add(*type, "E0104", fmt::format("'{}' is a type of <StructRef> only", type->value));
      field.type = Type::Double;
    } else if (!is_carried(field.type) && numbers_only && !told) {
      problems_.add(*type, "E0104",
                    fmt::format("'{}' is a type of parameters, of a function's arguments and of an own service only",
                                type->value),
                    "real-time links, devices and events carry numbers: a switch as UINT8; an event may carry a TEXT");
      field.type = Type::Double;
    }
  }
  if (field.type == Type::Text) {
    static_assert(max_text_octets + sizeof(std::uint16_t) == max_argument_octets);
    const auto octets = attributes.required_integer<std::uint16_t>("octets", 1, max_text_octets);
    // As the framework's own events have it: so many octets, read as words by whoever is told of them.
    if (says == Says::Told) field.type = Type::Uint8, field.count = octets, field.text = true;
    else field.text_octets = octets;
    return field;
  }
  field.count = attributes.integer_or<std::uint32_t>("count", 1, says == Says::Lent ? max_lent_count : max_count, 1);
  if (field.type == Type::Bool) return field;
  field.unit = attributes.text("unit");
  if (field.unit.size() > 32)
    problems_.add(*attributes.element().find("unit"), "E0114", "a unit has at most 32 octets");
  const bool all = says == Says::WordsAndRange || says == Says::Argument;
  if (all || says == Says::Told || says == Says::Report) read_words(attributes, field);
  if (all || says == Says::Range) check_field_range(attributes, field);
  return field;
}

void FieldReader::read_words(Attributes& attributes, Field& field) {
  const auto* use = attributes.optional("enumeration");
  if (use == nullptr) return;
  field.enumeration = use->value;
  enumeration_uses_.push_back({use, use->value, field.type});
}

void FieldReader::check_field_range(Attributes& attributes, Field& field) {
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

void FieldReader::read_plain(const xml::Element& element, std::vector<Field>& fields, Unique& names, Says says,
                             NameKind kind) {
  Attributes attributes{element, problems_};
  Field field = read(attributes, says, kind);
  no_children(element, problems_);
  if (!field.name.empty()) names.add(field.name, place(element.at), problems_, element.name.size() + 1);
  fields.push_back(std::move(field));
}

void FieldReader::check_enumerations() {
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

void FieldReader::name_values(std::vector<Function::Argument>& arguments) {
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

}  // namespace hirosco::descriptor::detail
