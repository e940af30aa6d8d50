// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/framework_events.hpp"

#include <algorithm>

#include "hirosco/descriptor/model/framework_parameters.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::descriptor {
namespace {

// A dot: no author can declare an enumeration of this name.
constexpr const char* losses_enumeration = "FRAMEWORK.DEVICE_LOSS";
constexpr const char* errors_enumeration = "FRAMEWORK.ERRORS";
constexpr const char* resources_enumeration = "FRAMEWORK.RESOURCES";

constexpr const char* foreign_enumeration = "FRAMEWORK.FOREIGN";

/// By their place among the parameters.
void add_foreign_names(SubsystemDescriptor& subsystem) {
  if (std::ranges::find(subsystem.enumerations, foreign_enumeration, &Enumeration::name) !=
      subsystem.enumerations.end())
    return;
  Enumeration names{foreign_enumeration, {}};
  for (std::size_t i = 0; i < subsystem.parameters.size(); ++i)
    if (const Parameter& each = subsystem.parameters[i]; !each.from.empty())
      names.texts.push_back({static_cast<std::int64_t>(i), each.field.name});
  subsystem.enumerations.push_back(std::move(names));
}

template <class E>
void add_enumeration(SubsystemDescriptor& subsystem, const char* name) {
  if (std::ranges::find(subsystem.enumerations, name, &Enumeration::name) != subsystem.enumerations.end()) return;
  Enumeration enumeration{name, {}};
  for (const auto& row : EnumTexts<E>::table)
    enumeration.texts.push_back({static_cast<std::int64_t>(row.value), std::string{row.text}});
  subsystem.enumerations.push_back(std::move(enumeration));
}

[[nodiscard]] Field argument(const char* name, Type type, const char* enumeration = "") {
  Field field;
  field.name = name;
  field.type = type;
  field.enumeration = enumeration;
  return field;
}

/// What failed, in the words and numbers of whoever said so.
[[nodiscard]] std::vector<Field> failure_of(Field what) {
  Field text = argument("TEXT", Type::Uint8);
  text.count = framework_event::text_octets;
  text.text = true;
  return {std::move(what), argument("ERROR", Type::Uint8, errors_enumeration), argument("NUMBER", Type::Int64),
          std::move(text)};
}

[[nodiscard]] bool has_fall_backs(const SubsystemDescriptor& subsystem, std::size_t device) {
  return std::ranges::any_of(subsystem.configurations, [&](const Configuration& configuration) {
    return std::ranges::any_of(configuration.devices,
                               [&](const DeviceUse& use) { return use.device == device && !use.fall_backs.empty(); });
  });
}

/// A device may have characters in its name that an event may not.
[[nodiscard]] std::string event_name(std::string name, const char* suffix) {
  std::ranges::replace_if(name, [](char c) { return c == '-' || c == '.'; }, '_');
  return name + suffix;
}

}  // namespace

std::vector<std::string> required_sets(const SubsystemDescriptor& subsystem) {
  std::vector<std::string> sets;
  for (const auto& configuration : subsystem.configurations)
    for (const auto& wanted : configuration.requires_)
      if (std::ranges::find(sets, wanted.name) == sets.end()) sets.push_back(wanted.name);
  return sets;
}

void add_framework_events(SubsystemDescriptor& subsystem) {
  add_framework_parameters(subsystem);
  add_enumeration<DeviceLoss>(subsystem, losses_enumeration);
  add_enumeration<ErrorCode>(subsystem, errors_enumeration);
  add_enumeration<Resource>(subsystem, resources_enumeration);
  const auto add = [&](std::string name, std::uint16_t id, Severity severity, std::vector<Field> arguments) {
    if (std::ranges::find(subsystem.events, id, &Event::id) != subsystem.events.end()) return;
    // What makes somebody safe or takes a network down is known to whoever looks, whatever an author makes of its severity.
    subsystem.events.push_back({std::move(name), id, severity, std::move(arguments), {}, severity >= Severity::Medium});
  };
  using namespace framework_event;
  const Field state = argument("STATE", Type::Uint8, states_enumeration);
  add("STATE_CHANGED", state_changed, Severity::Info, {state});
  add("STATE_FAILED", state_failed, Severity::High, failure_of(state));
  add("CONFIGURATION_FAILED", configuration_failed, Severity::Low, failure_of(argument("CONFIGURATION", Type::Uint8)));
  add("CYCLE_OVERRUNS", cycle_overruns, Severity::Medium, {argument("IN_A_ROW", Type::Uint32)});
  add("REPORTS_LOST", reports_lost, Severity::Low,
      {argument("CYCLE_ANSWERS", Type::Uint32), argument("CYCLE_EVENTS", Type::Uint32),
       argument("CYCLE_HOUSEKEEPING", Type::Uint32), argument("ANSWERS", Type::Uint32),
       argument("EVENTS", Type::Uint32), argument("HOUSEKEEPING", Type::Uint32)});
  add("CYCLE_OVER_BUDGET", cycle_over_budget, Severity::Low,
      {argument("IN_A_ROW", Type::Uint32), argument("LONGEST_US", Type::Float)});
  add("SUPERVISOR_SILENT", supervisor_silent, Severity::Low, {argument("CYCLES", Type::Uint32)});
  add("RESOURCE_WARNING", resource_warning, Severity::Low,
      {argument("RESOURCE", Type::Uint8, resources_enumeration), argument("BLOCK", Type::Uint32),
       argument("USED", Type::Uint32), argument("LIMIT", Type::Uint32), argument("CROSSINGS", Type::Uint32)});
  add("CYCLE_NOT_REALTIME", cycle_not_realtime, Severity::Low,
      {argument("HEAP", Type::Uint32), argument("LOCKS", Type::Uint32), argument("OUTPUTS", Type::Uint32)});
  add("SERVICE_USES_HEAP", service_uses_heap, Severity::Low,
      {argument("ALLOCATIONS", Type::Uint32), argument("FREES", Type::Uint32)});
  if (!subsystem.service_loops.empty())
    add("SERVICE_LOOP_HANGS", service_loop_hangs, Severity::Low,
        {argument("LOOP", Type::Uint8), argument("FOR_MS", Type::Uint32)});
  if (std::ranges::any_of(subsystem.parameters, [](const Parameter& each) { return !each.from.empty(); })) {
    add_foreign_names(subsystem);
    add("FOREIGN_UNKNOWN", foreign_unknown, Severity::Low, {argument("PARAMETER", Type::Uint16, foreign_enumeration)});
  }
  for (std::size_t i = 0; i < subsystem.devices.size(); ++i)
    add(event_name(subsystem.devices[i].name, "_LOST"), device_lost(i), Severity::High,
        {argument("REASON", Type::Uint8, losses_enumeration), argument("SILENT_CYCLES", Type::Uint32),
         argument("DAMAGED", Type::Uint32), argument("WRONG_SIZE", Type::Uint32)});
  for (std::size_t i = 0; i < subsystem.devices.size(); ++i)
    if (has_fall_backs(subsystem, i))
      add(event_name(subsystem.devices[i].name, "_FALL_BACK"), fell_back(i), Severity::Low,
          {argument("REASON", Type::Uint8, losses_enumeration), argument("LEFT", Type::Uint8),
           argument("TAKEN", Type::Uint8), argument("COUNT", Type::Uint32)});
  const auto sets = required_sets(subsystem);
  for (std::size_t i = 0; i < sets.size(); ++i)
    add(event_name(sets[i], "_STALE"), set_stale(i), Severity::Medium, {argument("AGE", Type::Uint32)});
}

}  // namespace hirosco::descriptor
