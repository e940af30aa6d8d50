// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/xtce/subsystem_reports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "hirosco/pus/service/service_kind.hpp"

namespace hirosco::ground {
namespace {

using descriptor::HousekeepingStructure;

class SubsystemReports {
 public:
  SubsystemReports(SpaceSystem& system, TypeSet& types, const PacketRoot& root, const Catalogue& catalogue,
                   const descriptor::SubsystemDescriptor& subsystem)
      : system_{system}, types_{types}, root_{root}, catalogue_{catalogue}, subsystem_{subsystem} {}

  void add_parameters() {
    for (const auto& parameter : subsystem_.parameters) {
      std::vector<std::string>& paths = paths_.emplace_back();
      const std::string& name = parameter.field.name;
      if (parameter.members.empty()) {
        paths.push_back(
            system_.add_parameter(name, type_of(parameter.field), "", id_of(parameter.field.type, parameter.id)));
        continue;
      }
      SpaceSystem& structure = system_.add_system(name);
      std::vector<std::string> types;
      for (const auto& member : parameter.members) {
        types.push_back(type_of(member.field));
        paths.push_back(
            structure.add_parameter(member.field.name, types.back(), "", id_of(member.field.type, member.id)));
      }
      // Reports of ST[20] may carry the structure as a whole, or one that stands in it.
      add_whole(structure, "WHOLE", parameter.members, types, id_of(parameter.field.type, parameter.id));
      for (const auto& part : parameter.parts)
        add_whole(structure, part.name, std::span{parameter.members}.subspan(part.first, part.count),
                  std::span{types}.subspan(part.first, part.count), id_of(Type::Struct, part.id));
    }
  }

  void add_housekeeping() {
    add_structures(subsystem_.housekeeping);
    for (const auto& configuration : subsystem_.configurations) add_structures(configuration.housekeeping);
  }

  [[nodiscard]] EventArguments add_events() {
    EventArguments all;
    for (const auto& event : subsystem_.events) {
      if (event.arguments.empty()) continue;
      SpaceSystem& place =
          system_.add_system(event.name, fmt::format("Event {}, {}", event.id, to_text(event.severity)));
      Container container{.name = "event", .base = root_.event, .when = {apid(), {root_.event_id, number(event.id)}}};
      std::size_t octets = sizeof event.id;
      for (const auto& argument : event.arguments) {
        const std::string path = place.add_parameter(argument.name, type_of(argument));
        container.entries.push_back(entry_of(path));
        octets += argument.octets();
        all[event.id].push_back({argument.name, path, argument.unit});
      }
      container.when.push_back(with_data(root_, octets));
      container.entries.push_back(entry_of(root_.crc));
      place.add_container(container);
    }
    return all;
  }

  void add_own_services() {
    for (const auto& service : subsystem_.services)
      for (const auto& report : service.reports) {
        SpaceSystem& place = system_.add_system(report.name, fmt::format("TM[{},{}]", service.type, report.subtype));
        Container container{
            .name = "report",
            .base = root_.telemetry,
            .when = {apid(), {root_.service, number(service.type)}, {root_.subtype, number(report.subtype)}}};
        for (const auto& field : report.fields) add_field(place, container, field);
        container.entries.push_back(entry_of(root_.crc));
        place.add_container(container);
      }
  }

 private:
  [[nodiscard]] static std::string number(unsigned value) { return std::to_string(value); }
  [[nodiscard]] Condition apid() const { return {root_.apid, number(subsystem_.id)}; }
  [[nodiscard]] std::string id_of(Type type, std::uint8_t id) const {
    return std::to_string(ParameterId{subsystem_.id, type, id}.wire());
  }
  [[nodiscard]] std::string type_of(const descriptor::Field& field) {
    return types_.value(kind_of(field, catalogue_.texts_of(subsystem_, {}, field)));
  }

  void add_whole(SpaceSystem& place, const std::string& name, std::span<const descriptor::Parameter::Member> members,
                 std::span<const std::string> types, const std::string& id) {
    std::vector<std::pair<std::string, std::string>> all;
    XtceNames names;
    for (std::size_t i = 0; i < members.size(); ++i) all.emplace_back(names.unique(members[i].field.name), types[i]);
    (void)place.add_parameter(name, types_.aggregate(all), "All members, as a report of service 20 has them", id);
  }

  void add_field(SpaceSystem& place, Container& container, const descriptor::Function::Argument& field) {
    constexpr unsigned length_bits = 16;
    if (field.field.type == Type::Text) {
      container.entries.push_back(entry_of(
          place.add_parameter(field.field.name, types_.words_behind_length(length_bits, field.field.text_octets))));
      return;
    }
    auto texts = field.texts.empty() ? catalogue_.texts_of(subsystem_, {}, field.field) : field.texts;
    container.entries.push_back(
        entry_of(place.add_parameter(field.field.name, types_.value(kind_of(field.field, std::move(texts))))));
  }

  /// Adds to `entries`; returns the octets of them.
  std::size_t add_values(const std::vector<descriptor::ParameterRef>& references, std::vector<Element>& entries) const {
    std::size_t octets = 0;
    for (const auto& reference : references) {
      const auto& all = subsystem_.parameters[reference.parameter].members;
      const auto members = subsystem_.parameters[reference.parameter].members_at(reference.member);
      std::span paths = paths_[reference.parameter];
      if (!members.empty())
        paths = paths.subspan(static_cast<std::size_t>(members.data() - all.data()), members.size());
      for (const std::string& path : paths) entries.push_back(entry_of(path));
      for (const auto& field : descriptor::fields_of(subsystem_, reference)) octets += field.octets();
    }
    return octets;
  }

  /// Configurations may have structures of the same id: who looks at a report tells them by its length, and takes the first.
  void add_structures(const std::vector<HousekeepingStructure>& structures) {
    for (const auto& structure : structures) {
      std::size_t octets = sizeof structure.id;
      std::vector<Element> entries;
      octets += add_values(structure.sampled_once, entries);
      std::vector<std::pair<std::vector<Element>, std::uint16_t>> sets;
      for (const auto& set : structure.sampled_repeatedly) {
        auto& [samples, repetitions] = sets.emplace_back(std::vector<Element>{}, set.repetitions);
        octets += add_values(set.parameters, samples) * set.repetitions;
      }
      if (!known_.emplace(structure.id, octets).second) continue;
      const std::string name = fmt::format("HK_{}", structure.id);
      for (auto& [samples, repetitions] : sets) {
        const std::string each = system_.add_container(
            {.name = name + "_SAMPLES", .says = "One sample of several in a report", .entries = std::move(samples)});
        entries.push_back(included_times(each, repetitions));
      }
      entries.push_back(entry_of(root_.crc));
      system_.add_container({.name = name,
                             .entries = std::move(entries),
                             .base = root_.housekeeping,
                             .when = {apid(), {root_.structure_id, number(structure.id)}, with_data(root_, octets)},
                             .partition = true});
    }
  }

  SpaceSystem& system_;
  TypeSet& types_;
  const PacketRoot& root_;
  const Catalogue& catalogue_;
  const descriptor::SubsystemDescriptor& subsystem_;
  std::vector<std::vector<std::string>> paths_;  ///< of each parameter: its own, or those of its members
  std::set<std::pair<std::uint16_t, std::size_t>> known_;
};

}  // namespace

EventArguments add_subsystem_reports(SpaceSystem& system, TypeSet& types, const PacketRoot& root,
                                     const Catalogue& catalogue, const descriptor::SubsystemDescriptor& subsystem) {
  SubsystemReports reports{system, types, root, catalogue, subsystem};
  reports.add_parameters();
  reports.add_housekeeping();
  reports.add_own_services();
  return reports.add_events();
}

}  // namespace hirosco::ground
