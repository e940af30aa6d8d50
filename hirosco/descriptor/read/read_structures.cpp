// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <utility>

#include "hirosco/descriptor/read/detail/parameter_reader.hpp"

/// Structured parameters: members, structures within, arrays of structures (docs/adr/0103).
namespace hirosco::descriptor::detail {
namespace {

/// Structures in each other, the parameter itself among them.
constexpr int most_levels = 4;
constexpr std::int64_t most_elements = 64;
constexpr std::size_t most_members = 256;

/// What was read of one structure: names are their way from it.
struct Inside {
  std::vector<Parameter::Member> members;
  std::vector<Parameter::Part> parts;
  std::vector<std::pair<std::size_t, const xml::Attribute*>> init;  ///< of which member
};

/// Reads what stands in a structure.
class StructureReader {
 public:
  StructureReader(Problems& problems, FieldReader& fields, Unique& parameter_ids)
      : problems_{problems}, fields_{fields}, parameter_ids_{parameter_ids} {}
  [[nodiscard]] std::uint8_t read_structure_id(Attributes& attributes);
  [[nodiscard]] Inside read_inside(const xml::Element& element, int level);
  void expect_ranges(const xml::Element& structure);

 private:
  void read_member(const xml::Element& element, Inside& structure, Unique& names);
  void read_within(const xml::Element& element, Inside& outer, Unique& names, int level);
  void add_elements(Attributes& attributes, const std::string& name, std::size_t elements, const Inside& inner,
                    Inside& outer);

  Problems& problems_;
  FieldReader& fields_;
  Unique& parameter_ids_;
};

}  // namespace

void ParameterReader::read_structure(const xml::Element& element) {
  if (built_in_.read(element)) return;
  Attributes attributes{element, problems_};
  Parameter parameter;
  parameter.field.name = attributes.name();
  parameter.field.type = Type::Struct;
  parameter.field.at = place(element.at);
  StructureReader structure{problems_, fields_, parameter_ids_};
  parameter.id = structure.read_structure_id(attributes);
  read_access(attributes, parameter);
  claim_parameter_id(attributes, Type::Struct, parameter.id, parameter_ids_, problems_);
  if (!parameter.field.name.empty())
    parameter_names_.add(parameter.field.name, place(element.at), problems_, element.name.size() + 1);
  Inside inside = structure.read_inside(element, 1);
  if (parameter.writable()) structure.expect_ranges(element);
  parameter.members = std::move(inside.members);
  parameter.parts = std::move(inside.parts);
  for (const auto& [member, at] : inside.init)
    initial_values_.push_back({subsystem_.parameters.size(), static_cast<std::uint16_t>(member), at});
  read_persistent(attributes, parameter);
  read_from(attributes, parameter);
  subsystem_.parameters.push_back(std::move(parameter));
}

std::uint8_t StructureReader::read_structure_id(Attributes& attributes) {
  if (const auto* type = attributes.optional("type"); type != nullptr && type->value != "STRUCT")
    problems_.add(*type, "E0104", "the type of a <StructRef> is 'STRUCT', not " + in_quotes(type->value));
  return attributes.required_integer<std::uint8_t>("id", 0, 255);
}

Inside StructureReader::read_inside(const xml::Element& element, int level) {
  Inside inside;
  Unique names{"member name", "E0201"};
  each_child(element, problems_,
             {{"ParamRef", [&](const xml::Element& child) { read_member(child, inside, names); }, most_members},
              {"StructRef", [&](const xml::Element& child) { read_within(child, inside, names, level + 1); }}});
  const bool refused = std::ranges::find(element.children, "StructRef", &xml::Element::name) != element.children.end();
  if (inside.members.empty() && !refused) problems_.add(element, "E0106", "<StructRef> needs at least one <ParamRef>");
  return inside;
}

void StructureReader::read_member(const xml::Element& element, Inside& structure, Unique& names) {
  Attributes attributes{element, problems_};
  Parameter::Member member;
  member.field = fields_.read(attributes, Says::WordsAndRange);
  member.id = attributes.required_integer<std::uint8_t>("id", 0, 255);
  if (const auto* init = attributes.optional("init"); init != nullptr)
    structure.init.emplace_back(structure.members.size(), init);
  claim_parameter_id(attributes, member.field.type, member.id, parameter_ids_, problems_);
  no_children(element, problems_);
  if (!member.field.name.empty()) names.add(member.field.name, place(element.at), problems_, element.name.size() + 1);
  structure.members.push_back(std::move(member));
}

/// A structure within, or an array of them.
void StructureReader::read_within(const xml::Element& element, Inside& outer, Unique& names, int level) {
  if (level > most_levels)
    return problems_.add(element, "E0256", fmt::format("structures stand in each other more than {} deep", most_levels),
                         "give it a parameter of its own");
  Attributes attributes{element, problems_};
  const std::string name = attributes.name();
  const std::uint8_t id = read_structure_id(attributes);
  const auto elements = attributes.integer_or<std::size_t>("count", 1, most_elements, 1);
  claim_parameter_id(attributes, Type::Struct, id, parameter_ids_, problems_);
  if (!name.empty()) names.add(name, place(element.at), problems_, element.name.size() + 1);
  Inside inner = read_inside(element, level);
  inner.parts.insert(inner.parts.begin(), {.name = {},
                                           .id = id,
                                           .first = 0,
                                           .count = static_cast<std::uint16_t>(inner.members.size()),
                                           .at = place(element.at)});
  if (outer.members.size() + elements * inner.members.size() > most_members)
    return problems_.add(element, "E0256",
                         fmt::format("with '{}' a parameter has more than {} values and arrays", name, most_members),
                         "make several parameters of it");
  add_elements(attributes, name, elements, inner, outer);
}

/// Ids of the elements of an array go on, type by type, behind the highest of the element before.
void StructureReader::add_elements(Attributes& attributes, const std::string& name, std::size_t elements,
                                   const Inside& inner, Inside& outer) {
  struct Ids {
    unsigned lowest{255};
    unsigned highest{0};
  };
  std::map<Type, Ids> ids;
  const auto use = [&ids](Type type, std::uint8_t id) {
    Ids& of = ids[type];
    of = {std::min<unsigned>(of.lowest, id), std::max<unsigned>(of.highest, id)};
  };
  for (const auto& member : inner.members) use(member.field.type, member.id);
  for (const auto& part : inner.parts) use(Type::Struct, part.id);
  const xml::Attribute* count = attributes.optional("count");
  for (std::size_t element = 0; element < elements; ++element) {
    const std::string way = elements == 1 ? name : fmt::format("{}[{}]", name, element);
    bool beyond = false;
    bool taken = false;
    const auto id_of = [&](Type type, std::uint8_t first) {
      const auto id = first + element * (ids[type].highest - ids[type].lowest + 1);
      beyond = beyond || id > 255;
      if (element > 0 && !beyond && !taken)
        taken = !parameter_ids_.add(fmt::format("{} {}", to_text(type), id), place(count->value_at), problems_,
                                    count->value.size(),
                                    fmt::format("'{}' has it: ids of elements go on, type by type, behind those of the "
                                                "element before",
                                                way));
      return static_cast<std::uint8_t>(id);
    };
    const std::size_t first = outer.members.size();
    for (const auto& part : inner.parts)
      outer.parts.push_back({part.name.empty() ? way : way + "." + part.name, id_of(Type::Struct, part.id),
                             static_cast<std::uint16_t>(first + part.first), part.count, part.at});
    for (const auto& member : inner.members) {
      Parameter::Member own = member;
      own.field.name = way + "." + member.field.name;
      own.id = id_of(member.field.type, member.id);
      outer.members.push_back(std::move(own));
    }
    for (const auto& [member, at] : inner.init) outer.init.emplace_back(first + member, at);
    if (!taken && !beyond) continue;
    if (beyond)
      problems_.add(*count, "E0256", fmt::format("the ids of '{}' go beyond 255", way),
                    "ids of elements go on, type by type, behind those of the element before: begin lower");
    return;
  }
}

/// Each number of a structure that is set from outside has its range, at any depth.
void StructureReader::expect_ranges(const xml::Element& structure) {
  for (const xml::Element& child : structure.children)
    if (child.name == "StructRef") expect_ranges(child);
    else expect_range(child, problems_, "member");
}

}  // namespace hirosco::descriptor::detail
