// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/alike.hpp"
#include "hirosco/descriptor/model/in_flight.hpp"

namespace hirosco::descriptor {
namespace {

using alike::same_outputs;
using alike::same_reference;
using alike::same_structures;
using alike::same_use;

// What is the same is not touched: a cycle may be reading it, and what it reads and is different obstacles_in_force() has refused. Of ranges
// and defaults of arguments it reads none: those are judged and filled in where a call is asked for.

void take_field(Field& flown, const Field& fresh) {
  flown.minimum = fresh.minimum;
  flown.maximum = fresh.maximum;
  flown.at = fresh.at;
}

void take_functions(std::vector<Function>& flown, std::vector<Function>& fresh) {
  for (std::size_t i = 0; i < flown.size(); ++i) {
    flown[i].description = std::move(fresh[i].description);
    flown[i].at = fresh[i].at;
    for (std::size_t a = 0; a < flown[i].arguments.size(); ++a) {
      take_field(flown[i].arguments[a].field, fresh[i].arguments[a].field);
      flown[i].arguments[a].fallback = std::move(fresh[i].arguments[a].fallback);
    }
  }
}

void take_structures(std::vector<HousekeepingStructure>& flown, std::vector<HousekeepingStructure>& fresh) {
  if (!same_structures(flown, fresh)) flown = std::move(fresh);
}

void take_configuration(Configuration& flown, Configuration& fresh) {
  flown.power_w = fresh.power_w;
  flown.overruns = fresh.overruns;
  flown.self_test_within = fresh.self_test_within;
  take_structures(flown.housekeeping, fresh.housekeeping);
  flown.initial = std::move(fresh.initial);
  flown.at = fresh.at;
  for (std::size_t i = 0; i < flown.provides.size(); ++i)
    if (!std::ranges::equal(flown.provides[i].parameters, fresh.provides[i].parameters, same_reference))
      flown.provides[i].parameters = std::move(fresh.provides[i].parameters);
  for (std::size_t i = 0; i < flown.requires_.size(); ++i) {
    if (flown.requires_[i].fields.size() != fresh.requires_[i].fields.size())
      flown.requires_[i].fields = std::move(fresh.requires_[i].fields);
    flown.requires_[i].age = fresh.requires_[i].age;
    flown.requires_[i].at = fresh.requires_[i].at;
  }
  for (std::size_t i = 0; i < flown.devices.size(); ++i)
    if (same_use(flown.devices[i], fresh.devices[i])) flown.devices[i].at = fresh.devices[i].at;
    else flown.devices[i] = std::move(fresh.devices[i]);
}

void take_device(Device& flown, Device& fresh) {
  flown.at = fresh.at;
  const bool same = same_outputs(flown, fresh);
  for (std::size_t i = 0; i < flown.output.size(); ++i) {
    flown.output[i].field.at = fresh.output[i].field.at;
    if (same) continue;
    take_field(flown.output[i].field, fresh.output[i].field);
    flown.output[i].safe = std::move(fresh.output[i].safe);
  }
}

/// Where one has more than the other: the lists, and all that says by its place which parameter is meant.
void take_lists(SubsystemDescriptor& flown, const SubsystemDescriptor& fresh) {
  const auto same = [&](auto list, auto name) { return std::ranges::equal(flown.*list, fresh.*list, {}, name, name); };
  if (same(&SubsystemDescriptor::parameters, [](const Parameter& each) -> const auto& { return each.field.name; }) &&
      same(&SubsystemDescriptor::events, &Event::name) && same(&SubsystemDescriptor::functions, &Function::name) &&
      same(&SubsystemDescriptor::enumerations, &Enumeration::name))
    return;
  flown.parameters = fresh.parameters;
  flown.events = fresh.events;
  flown.functions = fresh.functions;
  flown.services = fresh.services;
  flown.enumerations = fresh.enumerations;
  flown.resources.queues = fresh.resources.queues;
  for (std::size_t i = 0; i < flown.subscribes.size(); ++i)
    for (std::size_t k = 0; k < flown.subscribes[i].foreign.size(); ++k)
      flown.subscribes[i].foreign[k].parameter = fresh.subscribes[i].foreign[k].parameter;
}

}  // namespace

void take_over(SubsystemDescriptor& flown, SubsystemDescriptor&& fresh) {
  flown.description = std::move(fresh.description);
  flown.text = std::move(fresh.text);
  if (!std::ranges::equal(flown.failures, fresh.failures, {}, &FailureName::name, &FailureName::name))
    flown.failures = std::move(fresh.failures);
  take_lists(flown, fresh);
  for (std::size_t i = 0; i < flown.parameters.size(); ++i) {
    Parameter &had = flown.parameters[i], &has = fresh.parameters[i];
    take_field(had.field, has.field);
    had.init = std::move(has.init);
    had.writable_states = has.writable_states;
    for (std::size_t m = 0; m < had.members.size(); ++m) take_field(had.members[m].field, has.members[m].field);
  }
  take_functions(flown.functions, fresh.functions);
  for (std::size_t i = 0; i < flown.services.size(); ++i)
    take_functions(flown.services[i].requests, fresh.services[i].requests);
  take_structures(flown.housekeeping, fresh.housekeeping);
  for (std::size_t i = 0; i < flown.devices.size(); ++i) take_device(flown.devices[i], fresh.devices[i]);
  for (std::size_t i = 0; i < flown.configurations.size(); ++i)
    take_configuration(flown.configurations[i], fresh.configurations[i]);
}

}  // namespace hirosco::descriptor
