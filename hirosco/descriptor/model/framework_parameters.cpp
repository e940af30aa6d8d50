// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/framework_parameters.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace hirosco::descriptor {
namespace {

[[nodiscard]] Parameter structure(const char* name, std::uint8_t id, std::vector<Parameter::Member> members) {
  Parameter made;
  made.field.name = name;
  made.field.type = Type::Struct;
  made.id = id;
  made.members = std::move(members);
  return made;
}

[[nodiscard]] Parameter::Member member(const char* name, std::uint8_t id, Type type, const char* unit = "",
                                       std::uint16_t count = 1) {
  Parameter::Member made;
  made.field.name = name;
  made.field.type = type;
  made.field.count = count;
  made.field.unit = unit;
  made.id = id;
  return made;
}

}  // namespace

std::vector<Parameter> framework_parameters() {
  using enum Type;
  return {
      structure(
          framework_parameter::cycle_stats, 39,
          {member("OVERRUNS", 244, Uint32), member("MAX_US", 240, Float, "us"), member("AVG_US", 241, Float, "us")}),
      structure(framework_parameter::cycle_times, 40,
                {member("EXECUTION", 240, Uint32, "", 16), member("LATENCY", 241, Uint32, "", 16)}),
      structure(framework_parameter::cycle_budget, 38,
                {member("BUDGET_US", 242, Float, "us"), member("LONGEST_US", 243, Float, "us"),
                 member("EXCEEDED", 245, Uint32)}),
      structure(framework_parameter::cycle_spin, 35,
                {member("SPIN_US", 244, Float, "us"), member("LONGEST_US", 245, Float, "us"),
                 member("EXCEEDED", 240, Uint64)}),
      structure(framework_parameter::loop_stats, 34,
                {member("BUDGET_US", 246, Float, "us", max_service_loops),
                 member("LONGEST_US", 247, Float, "us", max_service_loops),
                 member("EXCEEDED", 241, Uint64, "", max_service_loops),
                 member("MISSED", 242, Uint64, "", max_service_loops)}),
      structure(framework_parameter::link_stats, 41, {member("RECEIVED", 242, Uint32), member("LOST", 243, Uint32)}),
      structure(framework_parameter::resource_stats, 37,
                {member("MEMORY", 246, Uint32, "kB"),
                 member("MEMORY_HIGH", 247, Uint32, "kB"),
                 member("DESCRIPTORS", 248, Uint32),
                 member("DESCRIPTORS_HIGH", 249, Uint32),
                 member("THREADS", 250, Uint32),
                 member("THREADS_HIGH", 251, Uint32),
                 member("POOL_USED", 252, Uint32, "", most_pools),
                 member("POOL_HIGH", 253, Uint32, "", most_pools),
                 member("POOL_REFUSED", 254, Uint32),
                 member("PORTS", 250, Uint16),
                 member("PORTS_HIGH", 251, Uint16),
                 member("FILES", 252, Uint16),
                 member("FILES_HIGH", 253, Uint16),
                 member("HELD_REFUSED", 254, Uint16),
                 member("SHARED_MEMORY", 243, Uint64, "kB"),
                 member("SHARED_MEMORY_HIGH", 244, Uint64, "kB"),
                 member("PROCESSOR", 241, Uint16, "%"),
                 member("PROCESSOR_HIGH", 242, Uint16, "%"),
                 member("WAITING", 243, Uint16, "", 3),
                 member("WAITING_HIGH", 244, Uint16, "", 3),
                 member("QUEUES", 254, Uint8, "%", queues_of_subsystem),
                 member("QUEUES_HIGH", 255, Uint8, "%", queues_of_subsystem),
                 member("CORE", 245, Uint16)}),
      structure(framework_parameter::heap_uses, 33,
                {member("CYCLE", 255, Uint64), member("SERVICE", 254, Uint64), member("COUNTED", 255, Bool)}),
      structure(framework_parameter::descriptor, 36, {member("HASH", 255, Uint32), member("CHANGES", 240, Uint16)})};
}

std::string output_parameter(const Device& device) {
  std::string name = device.name;
  std::ranges::replace_if(name, [](char c) { return c == '-' || c == '.'; }, '_');
  return name + "_OUTPUT";
}

std::vector<Parameter> output_parameters(const std::vector<Device>& devices) {
  constexpr std::uint8_t first_structure = 42, highest_member = 239;
  std::vector<Parameter> parameters;
  std::map<Type, std::uint8_t> used;
  for (const Device& device : devices) {
    if (!device.actuator || device.output.empty()) continue;
    std::vector<Parameter::Member> members;
    for (const Device::Output& output : device.output)
      members.push_back({output.field, static_cast<std::uint8_t>(highest_member - used[output.field.type]++)});
    const auto id = static_cast<std::uint8_t>(first_structure + parameters.size());
    parameters.push_back(structure(output_parameter(device).c_str(), id, std::move(members)));
  }
  return parameters;
}

void add_framework_parameters(SubsystemDescriptor& subsystem) {
  if (std::ranges::find(subsystem.enumerations, states_enumeration, &Enumeration::name) ==
      subsystem.enumerations.end()) {
    Enumeration states{states_enumeration, {}};
    for (const auto& row : EnumTexts<State>::table)
      states.texts.push_back({static_cast<std::int64_t>(row.value), std::string{row.text}});
    subsystem.enumerations.push_back(std::move(states));
  }
  std::vector<Parameter> all = framework_parameters();
  std::ranges::move(output_parameters(subsystem.devices), std::back_inserter(all));
  for (Parameter& parameter : all)
    if (subsystem.find_parameter(parameter.field.name) == nullptr) subsystem.parameters.push_back(std::move(parameter));
}

std::vector<std::string> built_in_parameters(const SubsystemDescriptor& subsystem) {
  std::vector<std::string> names;
  for (const Parameter& parameter : framework_parameters()) names.push_back(parameter.field.name);
  for (const Device& device : subsystem.devices)
    if (device.actuator) names.push_back(output_parameter(device));
  return names;
}

}  // namespace hirosco::descriptor
