// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/mission_json.hpp"

#include "ground/model/json.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

template <class Texts>
[[nodiscard]] json texts_json(const Texts& texts) {
  json list = json::array();
  for (const auto& entry : texts) list.push_back({{"value", json_number(Number{entry.value})}, {"name", entry.text}});
  return list;
}

[[nodiscard]] json field_json(const descriptor::Field& field) {
  json result{{"name", field.name}, {"type", to_text(field.type)}, {"count", field.count}, {"unit", field.unit}};
  if (field.type == Type::Text) result["octets"] = field.text_octets;
  if (field.minimum) result["min"] = json_number(*field.minimum);
  if (field.maximum) result["max"] = json_number(*field.maximum);
  return result;
}

[[nodiscard]] json functions_json(const Catalogue& catalogue, const descriptor::SubsystemDescriptor& subsystem) {
  json list = json::array();
  for (const auto& function : catalogue.functions_of(subsystem)) {
    json arguments = json::array();
    for (const auto& argument : function.arguments) {
      json one = field_json(argument.field);
      if (argument.fallback) one["default"] = json_value(*argument.fallback);
      const auto texts = catalogue.texts_of(subsystem, function, argument);
      if (!texts.empty()) one["enumeration"] = texts_json(texts);
      arguments.push_back(std::move(one));
    }
    json states = json::array();
    for (const auto& row : EnumTexts<descriptor::State>::table)
      if (function.permitted_in(row.value)) states.push_back(row.text);
    list.push_back({{"name", function.name},
                    {"description", function.description},
                    {"service", function.service},
                    {"subtype", function.subtype},
                    {"essential", function.essential},
                    {"confirm", function.confirm},
                    {"states", std::move(states)},
                    {"arguments", std::move(arguments)}});
  }
  return list;
}

[[nodiscard]] json housekeeping_json(const Catalogue& catalogue, const descriptor::SubsystemDescriptor& subsystem) {
  json list = json::array();
  for (const Report& report : catalogue.reports()) {
    if (report.apid != subsystem.id) continue;
    json columns = json::array();
    for (const Place& place : report.places) {
      const Column& column = catalogue.columns()[place.column];
      json one{{"name", column.name}, {"type", to_text(column.type)}, {"unit", column.unit}};
      if (column.type == Type::Text) one["octets"] = column.text_octets;
      if (column.minimum) one["min"] = json_number(*column.minimum);
      if (column.maximum) one["max"] = json_number(*column.maximum);
      if (column.enumeration != nullptr) one["enumeration"] = texts_json(column.enumeration->texts);
      columns.push_back(std::move(one));
    }
    list.push_back({{"sid", report.sid},
                    {"period_s", seconds(report.period)},
                    {"configuration", report.configuration},
                    {"columns", std::move(columns)}});
  }
  return list;
}

[[nodiscard]] json subsystem_json(const Catalogue& catalogue, const descriptor::SubsystemDescriptor& subsystem) {
  json configurations = json::array();
  for (const auto& configuration : subsystem.configurations)
    configurations.push_back(
        {{"id", configuration.id},
         {"name", configuration.name},
         {"sampling_hz", configuration.sampling > Duration{0} ? 1.0 / seconds(configuration.sampling) : 0.0}});
  json events = json::array();
  for (const auto& event : subsystem.events) {
    json arguments = json::array();
    for (const auto& argument : event.arguments) arguments.push_back(field_json(argument));
    events.push_back({{"id", event.id},
                      {"name", event.name},
                      {"severity", to_text(event.severity)},
                      {"arguments", std::move(arguments)}});
  }
  json states = json::array();
  for (const auto& row : EnumTexts<descriptor::State>::table) states.push_back(row.text);
  return {{"id", subsystem.id},
          {"name", subsystem.name},
          {"description", subsystem.description},
          {"configurations", std::move(configurations)},
          {"functions", functions_json(catalogue, subsystem)},
          {"housekeeping", housekeeping_json(catalogue, subsystem)},
          {"events", std::move(events)},
          {"states", std::move(states)}};
}

[[nodiscard]] json links_json(const Catalogue& catalogue) {
  json list = json::array();
  for (const auto& link : catalogue.mission().links) {
    json one{{"id", link.id},      {"from", link.from},          {"provides", link.provides},
             {"to", link.to},      {"requires", link.requires_}, {"required", true},
             {"rate_hz", nullptr}, {"age_limit_cycles", nullptr}};
    const auto* consumer = catalogue.find(std::string_view{link.to});
    const auto* producer = catalogue.find(std::string_view{link.from});
    if (consumer == nullptr || producer == nullptr) continue;
    for (const auto& configuration : consumer->configurations)
      for (const auto& wanted : configuration.requires_)
        if (wanted.name == link.requires_) {
          one["required"] = wanted.required;
          one["age_limit_cycles"] = wanted.age.realtime;
          one["age_limit_cycles_reduced"] = wanted.age.reduced;
        }
    for (const auto& configuration : producer->configurations)
      for (const auto& provided : configuration.provides)
        if (provided.name == link.provides && configuration.sampling > Duration{0})
          one["rate_hz"] = 1.0 / seconds(configuration.sampling);
    list.push_back(std::move(one));
  }
  return list;
}

[[nodiscard]] json modes_json(const descriptor::Mission& mission) {
  json list = json::array();
  for (const auto& mode : mission.modes) {
    json permits = json::array();
    for (const auto& permit : mode.permits) {
      if (!permit.from.empty() && !permit.names(descriptor::ground_origin)) continue;  // is no operator's
      permits.push_back(
          {{"subsystem", permit.subsystem}, {"functions", permit.functions}, {"services", permit.services}});
    }
    json commission = json::array();
    for (const auto& step : mode.commission)
      commission.push_back(
          {{"subsystem", step.subsystem}, {"configuration", step.configuration}, {"state", to_text(step.state)}});
    list.push_back({{"id", mode.id},
                    {"name", mode.name},
                    {"permits", std::move(permits)},
                    {"commission", std::move(commission)},
                    {"establish", mode.establish}});
  }
  return list;
}

[[nodiscard]] json devices_json(const descriptor::Mission& mission, const FaultTexts& known) {
  json list = json::array();
  for (const auto& device : mission.devices) {
    json faults = json::array();
    if (const auto found = known.find(device.name); found != known.end())
      for (const FaultText& fault : found->second) faults.push_back({{"line", fault.line}, {"text", fault.text}});
    list.push_back({{"name", device.name},
                    {"subsystem", device.subsystem},
                    {"device", device.device},
                    {"faults", std::move(faults)}});
  }
  return list;
}

}  // namespace

json mission_json(const Catalogue& catalogue, std::span<const Transition> transitions, const FaultTexts& faults) {
  const auto& mission = catalogue.mission();
  json subsystems = json::array();
  for (const auto* subsystem : catalogue.subsystems()) subsystems.push_back(subsystem_json(catalogue, *subsystem));
  json edges = json::array();
  for (const Transition& edge : transitions)
    edges.push_back(
        {{"from", to_text(edge.from)}, {"to", to_text(edge.to)}, {"kind", edge.failure ? "failure" : "commanded"}});
  return {{"name", mission.name},
          {"simulated", !mission.devices.empty()},
          {"epoch_unix_s", -onboard_epoch_to_unix_s - tai_minus_utc_s},
          {"subsystems", std::move(subsystems)},
          {"links", links_json(catalogue)},
          {"modes", modes_json(mission)},
          {"start_mode", mission.start_mode},
          {"devices", devices_json(mission, faults)},
          {"transitions", std::move(edges)}};
}

}  // namespace hirosco::ground
