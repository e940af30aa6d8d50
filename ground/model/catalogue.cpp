// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/model/catalogue.hpp"

#include <algorithm>

#include "hirosco/parameter/number.hpp"
#include "hirosco/parameter/text.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/utilities/utf8.hpp"

namespace hirosco::ground {
namespace {

[[nodiscard]] std::string element_name(const std::string& name, const descriptor::Field& field, std::uint16_t i) {
  return field.values() == 1 ? name : name + "[" + std::to_string(i) + "]";
}

[[nodiscard]] const descriptor::Enumeration* enumeration_of(const descriptor::SubsystemDescriptor& subsystem,
                                                            const descriptor::Field& field) {
  const auto found = std::ranges::find(subsystem.enumerations, field.enumeration, &descriptor::Enumeration::name);
  return field.enumeration.empty() || found == subsystem.enumerations.end() ? nullptr : &*found;
}

}  // namespace

Catalogue::Catalogue(descriptor::Mission mission) : mission_{std::move(mission)} {
  subsystems_ = mission_.everybody();
  for (const auto* subsystem : subsystems_) add_columns(*subsystem);
  for (const auto* subsystem : subsystems_) {
    add_reports(*subsystem, nullptr, subsystem->housekeeping);
    for (const auto& configuration : subsystem->configurations)
      add_reports(*subsystem, &configuration, configuration.housekeeping);
  }
}

void Catalogue::add_columns(const descriptor::SubsystemDescriptor& subsystem) {
  const auto add = [&](const std::string& name, const descriptor::Field& field) {
    for (std::uint32_t i = 0; i < field.values(); ++i) {
      const std::string element = element_name(name, field, static_cast<std::uint16_t>(i));
      column_index_.emplace(element, columns_.size());
      const auto real = [](const std::optional<Number>& limit) {
        return limit ? std::optional{limit->real()} : std::nullopt;
      };
      columns_.push_back({element, subsystem.id, field.type, field.text_octets, field.unit, real(field.minimum),
                          real(field.maximum), enumeration_of(subsystem, field)});
    }
  };
  for (const auto& parameter : subsystem.parameters) {
    const std::string name = subsystem.name + "." + parameter.field.name;
    if (parameter.members.empty()) add(name, parameter.field);
    for (const auto& member : parameter.members) add(name + "." + member.field.name, member.field);
  }
}

void Catalogue::add_reports(const descriptor::SubsystemDescriptor& subsystem,
                            const descriptor::Configuration* configuration,
                            const std::vector<descriptor::HousekeepingStructure>& structures) {
  const Duration cycle = configuration != nullptr           ? configuration->sampling
                         : subsystem.configurations.empty() ? Duration{0}
                                                            : subsystem.configurations.front().sampling;
  for (const auto& structure : structures) {
    Report report;
    report.apid = subsystem.id;
    report.sid = structure.id;
    report.configuration = configuration != nullptr ? configuration->id : std::uint8_t{0};
    report.period = cycle * static_cast<int>(structure.interval_cycles);
    std::size_t offset = sizeof structure.id;
    add_places(subsystem, structure.sampled_once, report, offset);
    for (const auto& set : structure.sampled_repeatedly)
      for (std::uint16_t i = 0; i < set.repetitions; ++i) {
        Report newest;
        add_places(subsystem, set.parameters, newest, offset);
        if (i + 1 == set.repetitions)
          report.places.insert(report.places.end(), newest.places.begin(), newest.places.end());
      }
    report.octets = offset;
    reports_.push_back(std::move(report));
  }
}

void Catalogue::add_places(const descriptor::SubsystemDescriptor& subsystem,
                           const std::vector<descriptor::ParameterRef>& references, Report& report,
                           std::size_t& offset) const {
  for (const auto& reference : references) {
    const auto& parameter = subsystem.parameters[reference.parameter];
    const std::string name = subsystem.name + "." + parameter.field.name;
    const bool structure = parameter.field.type == Type::Struct;
    for (const auto& field : descriptor::fields_of(subsystem, reference))
      for (std::uint32_t i = 0; i < field.values(); ++i) {
        const auto column =
            find_column(element_name(structure ? name + "." + field.name : name, field, static_cast<std::uint16_t>(i)));
        if (column) report.places.push_back({*column, offset});
        offset += field.octets() / field.values();
      }
  }
}

const descriptor::SubsystemDescriptor* Catalogue::find(std::uint16_t apid) const noexcept {
  const auto found = std::ranges::find(subsystems_, apid, &descriptor::SubsystemDescriptor::id);
  return found != subsystems_.end() ? *found : nullptr;
}

const descriptor::SubsystemDescriptor* Catalogue::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find(subsystems_, name, &descriptor::SubsystemDescriptor::name);
  return found != subsystems_.end() ? *found : nullptr;
}

std::string Catalogue::name_of(std::uint16_t apid) const {
  const auto* subsystem = find(apid);
  if (subsystem != nullptr) return subsystem->name;
  std::string text = "APID ";
  return text.append(std::to_string(apid));
}

std::optional<std::size_t> Catalogue::find_column(std::string_view name) const {
  const auto found = column_index_.find(std::string{name});
  return found != column_index_.end() ? std::optional{found->second} : std::nullopt;
}

const Report* Catalogue::report_of(std::uint16_t apid, Octets source_data) const noexcept {
  OctetReader reader{source_data};
  const auto sid = reader.get<std::uint16_t>();
  if (!reader.good()) return nullptr;
  const auto found = std::ranges::find_if(reports_, [&](const Report& report) {
    return report.apid == apid && report.sid == sid && report.octets == source_data.size();
  });
  return found != reports_.end() ? &*found : nullptr;
}

double Catalogue::read(const Place& place, Octets source_data) const noexcept {
  OctetReader reader{source_data.subspan(place.offset)};
  const Type type = columns_[place.column].type;
  return type == Type::Text ? std::numeric_limits<double>::quiet_NaN() : get_number(reader, type);
}

std::string Catalogue::words(const Place& place, Octets source_data) const {
  const Column& column = columns_[place.column];
  if (column.type != Type::Text) return {};
  return printable_words(fixed_words(source_data.subspan(place.offset, column.text_octets)));
}

std::vector<descriptor::Function> Catalogue::functions_of(const descriptor::SubsystemDescriptor& subsystem) const {
  std::vector<descriptor::Function> functions = pus::requests_of(subsystem);
  for (auto& function : functions) {
    if (function.name == "SET_STATE")
      function.description = "Takes the subsystem to a state, through those between; Offline starts one that is down";
    if (function.name == "CONFIGURE")
      function.description =
          "Chooses the configuration, in Pre-Operational; one that is declared compatible also while it acts";
  }
  return functions;
}

std::vector<descriptor::EnumerationText> Catalogue::texts_of(const descriptor::SubsystemDescriptor& subsystem,
                                                             const descriptor::Function& function,
                                                             const descriptor::Field& argument) const {
  std::vector<descriptor::EnumerationText> texts;
  if (const auto* enumeration = enumeration_of(subsystem, argument)) return enumeration->texts;
  const bool supervisor = &subsystem == &mission_.supervisor;
  if (function.name == "SET_STATE")
    for (const auto& row : EnumTexts<descriptor::State>::table)
      texts.push_back({static_cast<std::int64_t>(row.value), std::string{row.text}});
  if (function.name == "CONFIGURE")
    for (const auto& configuration : subsystem.configurations) texts.push_back({configuration.id, configuration.name});
  if (supervisor && (function.name == "SET_MODE" || function.name == "ENTER_MODE"))
    for (const auto& mode : mission_.modes) texts.push_back({mode.id, mode.name});
  if (supervisor && (function.name == "LINK" || function.name == "UNLINK"))
    for (const auto& link : mission_.links)
      texts.push_back({link.id, link.from + "." + link.provides + " to " + link.to});
  if (supervisor && function.name == "SET_DATABASE") texts = {{0, "sqlite"}, {1, "ascii"}, {2, "postgresql"}};
  return texts;
}

std::optional<std::size_t> Catalogue::supervisor_column(std::string_view name) const {
  const std::string whole = mission_.supervisor.name + "." + std::string{name};
  if (const auto single = find_column(whole)) return single;
  return find_column(whole + "[0]");
}

std::size_t Catalogue::supervisor_rows(std::string_view name) const {
  const std::string whole = mission_.supervisor.name + "." + std::string{name};
  if (find_column(whole)) return 1;
  std::size_t rows = 0;
  while (find_column(whole + "[" + std::to_string(rows) + "]")) ++rows;
  return rows;
}

}  // namespace hirosco::ground
