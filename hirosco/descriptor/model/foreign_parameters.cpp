// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "hirosco/descriptor/model/reported.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/native_layout.hpp"

/// Parameters whose values are those of other subsystems (paper 4.1, docs/adr/0103).
namespace hirosco::descriptor {
namespace {

[[nodiscard]] std::string form_of(const std::vector<Field>& fields) {
  std::string text;
  for (const Field& field : fields) {
    text.append(text.empty() ? "" : ", ").append(descriptor_text(field.type, field.elements()));
    if (!field.unit.empty()) text.append(" in ").append(field.unit);
  }
  return text;
}

/// Octets of what stands in front of a place within its parameter.
[[nodiscard]] std::size_t octets_before(const Parameter& parameter, std::optional<std::uint16_t> member) {
  std::size_t octets = 0;
  for (const auto* each = parameter.members.data(); each != parameter.members_at(member).data(); ++each)
    octets += each->field.octets();
  return octets;
}

/// Where the place stands in what the structure samples once; empty: nowhere.
[[nodiscard]] std::optional<std::size_t> offset_in(const HousekeepingStructure& structure,
                                                   const SubsystemDescriptor& other, const ParameterRef& place) {
  std::size_t offset = 0;
  for (const ParameterRef& reference : structure.sampled_once) {
    const Parameter& parameter = other.parameters[reference.parameter];
    if (covers(other, reference, place))
      return offset + octets_before(parameter, place.member) - octets_before(parameter, reference.member);
    offset += parameter.octets(reference.member);
  }
  return std::nullopt;
}

/// The longest time between two reports, in any configuration that has the structure.
[[nodiscard]] Duration longest_interval(const SubsystemDescriptor& other, std::uint16_t id) {
  Duration longest{};
  const auto look = [&](const std::vector<HousekeepingStructure>& structures, Duration cycle) {
    for (const HousekeepingStructure& each : structures)
      if (each.id == id) longest = std::max(longest, cycle * static_cast<int>(each.interval_cycles));
  };
  for (const Configuration& configuration : other.configurations) {
    look(other.housekeeping, configuration.sampling);
    look(configuration.housekeeping, configuration.sampling);
  }
  return longest;
}

/// One of the structures that are heard. They are the same in every configuration: resolve(things) has refused others.
[[nodiscard]] const HousekeepingStructure* find_structure(const SubsystemDescriptor& other, std::string_view id) {
  const auto in = [&](const std::vector<HousekeepingStructure>& structures) -> const HousekeepingStructure* {
    for (const HousekeepingStructure& each : structures)
      if (std::to_string(each.id) == id) return &each;
    return nullptr;
  };
  if (const auto* found = in(other.housekeeping)) return found;
  for (const Configuration& configuration : other.configurations)
    if (const auto* found = in(configuration.housekeeping)) return found;
  return nullptr;
}

[[nodiscard]] std::string resolve_one(const SubsystemDescriptor& own, const Subscribes& heard, Foreign& foreign,
                                      const SubsystemDescriptor& other) {
  const Parameter& parameter = own.parameters[foreign.parameter];
  const auto place = find_place(other, foreign.name);
  if (!place) return "it has no such parameter";
  const std::string mine = form_of(fields_of(own, {{}, foreign.parameter, std::nullopt, {}}));
  if (const std::string theirs = form_of(fields_of(other, *place)); mine != theirs)
    return "there it is " + theirs + ", here " + mine;
  for (const Thing& thing : heard.things) {
    if (thing.kind != Thing::Kind::Housekeeping) continue;
    const HousekeepingStructure* structure = find_structure(other, thing.name);
    const auto offset = structure != nullptr ? offset_in(*structure, other, *place) : std::nullopt;
    if (!offset) continue;
    if (const Duration interval = longest_interval(other, structure->id); interval > parameter.age)
      return "it is reported each " + std::to_string(interval / std::chrono::milliseconds{1}) +
             " ms, and would be too old by then";
    foreign.structure = structure->id;
    foreign.offset = *offset;
    return {};
  }
  return "none of the structures that are heard of it has it";
}

/// Of its reports, with the id in front.
[[nodiscard]] std::size_t octets_of(const HousekeepingStructure& structure, const SubsystemDescriptor& subsystem) {
  const auto octets = [&](const std::vector<ParameterRef>& references) {
    std::size_t sum = 0;
    for (const ParameterRef& each : references) sum += subsystem.parameters[each.parameter].octets(each.member);
    return sum;
  };
  std::size_t sum = sizeof structure.id + octets(structure.sampled_once);
  for (const auto& set : structure.sampled_repeatedly) sum += set.repetitions * octets(set.parameters);
  return sum;
}

/// Null: this configuration does not report it by itself.
[[nodiscard]] const HousekeepingStructure* find_enabled(const SubsystemDescriptor& subsystem,
                                                        const Configuration& configuration, std::uint16_t id) {
  for (const auto* structures : {&subsystem.housekeeping, &configuration.housekeeping})
    for (const HousekeepingStructure& each : *structures)
      if (each.id == id && each.enabled) return &each;
  return nullptr;
}

/// Where it stands, if it is the same and often enough in every configuration.
[[nodiscard]] std::optional<ReportedAt> find_reported_in(const SubsystemDescriptor& subsystem, std::uint16_t id,
                                                         const ParameterRef& place, Duration age) {
  std::optional<ReportedAt> found;
  for (const Configuration& configuration : subsystem.configurations) {
    const HousekeepingStructure* structure = find_enabled(subsystem, configuration, id);
    const auto offset = structure != nullptr ? offset_in(*structure, subsystem, place) : std::nullopt;
    if (!offset) return std::nullopt;
    if (configuration.sampling * static_cast<int>(structure->interval_cycles) > age) return std::nullopt;
    const ReportedAt here{id, *offset, octets_of(*structure, subsystem)};
    if (found && (found->offset != here.offset || found->octets != here.octets)) return std::nullopt;
    found = here;
  }
  return found;
}

}  // namespace

std::expected<ReportedAt, std::string> find_reported(const SubsystemDescriptor& subsystem, const ParameterRef& place,
                                                     Duration age) {
  if (!subsystem.configurations.empty())
    for (const auto* structures : {&subsystem.housekeeping, &subsystem.configurations.front().housekeeping})
      for (const HousekeepingStructure& each : *structures)
        if (const auto found = find_reported_in(subsystem, each.id, place, age)) return *found;
  return std::unexpected{"no structure reports it in every configuration, alike and at least each " +
                         std::to_string(age / std::chrono::milliseconds{1}) + " ms"};
}

NoForeign resolve_foreign(const SubsystemDescriptor& own, Subscribes& heard, const SubsystemDescriptor& other) {
  for (Foreign& foreign : heard.foreign)
    if (std::string why = resolve_one(own, heard, foreign, other); !why.empty()) return {&foreign, std::move(why)};
  return {};
}

}  // namespace hirosco::descriptor
