// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"

namespace hirosco::descriptor {
namespace {

template <class Range, class Key, class Projection>
auto find_in(const Range& range, const Key& key, Projection projection) noexcept -> decltype(&*range.begin()) {
  for (const auto& each : range)
    if (std::invoke(projection, each) == key) return &each;
  return nullptr;
}

}  // namespace

const Parameter* SubsystemDescriptor::find_parameter(std::string_view parameter) const noexcept {
  return find_in(parameters, parameter, [](const Parameter& p) -> std::string_view { return p.field.name; });
}
const Event* SubsystemDescriptor::find_event(std::string_view event) const noexcept {
  return find_in(events, event, &Event::name);
}
const CustomService* SubsystemDescriptor::find_service(std::uint8_t type) const noexcept {
  return find_in(services, type, &CustomService::type);
}
const CustomService* SubsystemDescriptor::find_service(std::string_view service) const noexcept {
  return find_in(services, service, &CustomService::name);
}
const Function* SubsystemDescriptor::find_request(std::uint8_t service, std::uint8_t subtype) const noexcept {
  const CustomService* own = find_service(service);
  return own == nullptr ? nullptr : find_in(own->requests, subtype, &Function::subtype);
}

const Function* SubsystemDescriptor::find_function(std::string_view function) const noexcept {
  return find_in(functions, function, &Function::name);
}
const Function* SubsystemDescriptor::find_named(std::string_view request) const noexcept {
  if (const Function* function = find_function(request)) return function;
  for (const CustomService& service : services)
    if (const Function* found = find_in(service.requests, request, &Function::name)) return found;
  return nullptr;
}

bool SubsystemDescriptor::offers(std::uint8_t type, const Configuration* in_force) const noexcept {
  if (in_force != nullptr)
    if (const ServiceUse* use = find_in(in_force->services, type, &ServiceUse::type)) return use->offered;
  const ServiceUse* const use = find_in(service_uses, type, &ServiceUse::type);
  return use == nullptr || use->offered;
}
int SubsystemDescriptor::loop_of(std::uint8_t type) const noexcept {
  const ServiceUse* const use = find_in(service_uses, type, &ServiceUse::type);
  return use == nullptr ? -1 : use->loop;
}
const ServiceLoop& SubsystemDescriptor::loop_in_force(std::size_t loop, const Configuration* in_force) const noexcept {
  const ServiceLoop& own = service_loops[loop];
  const ServiceLoop* const other =
      in_force == nullptr ? nullptr : find_in(in_force->paces, own.name, &ServiceLoop::name);
  return other == nullptr ? own : *other;
}
const Bumpless* SubsystemDescriptor::bumpless_between(std::uint8_t one, std::uint8_t other) const noexcept {
  if (one == other) return nullptr;
  const auto found = std::ranges::find_if(bumpless, [&](const Bumpless& each) {
    const auto has = [&](std::uint8_t sought) {
      return std::ranges::find(each.configurations, sought) != each.configurations.end();
    };
    return has(one) && has(other);
  });
  return found == bumpless.end() ? nullptr : &*found;
}

std::string_view resolve(Commands& commands, const SubsystemDescriptor& commanded) {
  commands.apid = commanded.id;
  commands.file = commanded.file;
  commands.requests.clear();
  for (const std::string& name : commands.functions) {
    const Function* found = commanded.find_named(name);
    if (found == nullptr) return name;
    commands.requests.push_back(*found);
  }
  return {};
}

namespace {

[[nodiscard]] std::string_view resolve_parameter(Thing& thing, const SubsystemDescriptor& other) {
  const auto place = find_place(other, thing.name);
  if (!place) return "it has no such parameter";
  if (thing.kind == Thing::Kind::Set && !other.parameters[place->parameter].writable())
    return "its descriptor makes this parameter never writable";
  thing.id = identity_of(other, *place).wire();
  thing.fields = fields_of(other, *place);
  return {};
}

/// A structure of several configurations must be one and the same.
[[nodiscard]] std::string_view resolve_structure(Thing& thing, const SubsystemDescriptor& other) {
  const auto fields = [&](const HousekeepingStructure& structure) {
    std::vector<Field> all;
    for (const ParameterRef& reference : structure.sampled_once)
      for (Field& field : fields_of(other, reference)) all.push_back(std::move(field));
    return all;
  };
  const auto is_same = [](const Field& a, const Field& b) { return a.type == b.type && a.elements() == b.elements(); };
  bool found = false;
  std::string_view why;
  const auto look = [&](const std::vector<HousekeepingStructure>& structures) {
    for (const HousekeepingStructure& each : structures) {
      if (std::to_string(each.id) != thing.name) continue;
      auto these = fields(each);
      if (!each.sampled_repeatedly.empty()) why = "it samples values several times in an interval";
      if (found && !std::ranges::equal(these, thing.fields, is_same))
        why = "its configurations have several of this id";
      found = true;
      thing.id = each.id;
      thing.fields = std::move(these);
    }
  };
  look(other.housekeeping);
  for (const Configuration& configuration : other.configurations) look(configuration.housekeeping);
  return found ? why : "it has no such housekeeping structure";
}

}  // namespace

NoThing resolve(std::vector<Thing>& things, const SubsystemDescriptor& other) {
  for (Thing& thing : things) {
    std::string_view why;
    if (thing.kind == Thing::Kind::Event) {
      const Event* event = other.find_event(thing.name);
      if (event == nullptr) return {&thing, "it has no such event"};
      thing.id = event->id;
      thing.fields = event->arguments;
    } else {
      why = thing.kind == Thing::Kind::Housekeeping ? resolve_structure(thing, other) : resolve_parameter(thing, other);
    }
    if (!why.empty()) return {&thing, why};
  }
  return {};
}

const Configuration* SubsystemDescriptor::find_configuration(std::string_view configuration) const noexcept {
  return find_in(configurations, configuration, &Configuration::name);
}
const Configuration* SubsystemDescriptor::find_configuration(std::uint8_t configuration) const noexcept {
  return find_in(configurations, configuration, &Configuration::id);
}

std::vector<const SubsystemDescriptor*> Mission::everybody() const {
  std::vector<const SubsystemDescriptor*> all{&supervisor};
  for (const MissionSubsystem& member : subsystems) all.push_back(&member.subsystem);
  return all;
}
const SubsystemDescriptor* Mission::find_member(std::string_view member) const noexcept {
  if (member == supervisor.name) return &supervisor;
  const auto* found = find_subsystem(member);
  return found != nullptr ? &found->subsystem : nullptr;
}
const SubsystemDescriptor* Mission::find_member(std::uint16_t apid) const noexcept {
  if (apid == supervisor.id) return &supervisor;
  const auto* found = find_subsystem(apid);
  return found != nullptr ? &found->subsystem : nullptr;
}
const MissionSubsystem* Mission::find_subsystem(std::string_view subsystem) const noexcept {
  return find_in(subsystems, subsystem, [](const MissionSubsystem& m) -> std::string_view { return m.subsystem.name; });
}
const MissionSubsystem* Mission::find_subsystem(std::uint16_t apid) const noexcept {
  return find_in(subsystems, apid, [](const MissionSubsystem& m) { return m.subsystem.id; });
}
const Mode* Mission::find_mode(std::string_view mode) const noexcept { return find_in(modes, mode, &Mode::name); }
const MissionLink* Mission::find_link(std::uint8_t link) const noexcept {
  return find_in(links, link, &MissionLink::id);
}

const Mode* mode_up(const Mission& mission, std::string_view now, std::string_view usual) noexcept {
  const auto brings_up = [&](std::string_view name) -> const Mode* {
    const Mode* const mode = mission.find_mode(name);
    return mode != nullptr && !mode->commission.empty() ? mode : nullptr;
  };
  if (now != mission.initial_mode)
    if (const Mode* const mode = brings_up(now)) return mode;
  return brings_up(usual);
}

double cycle_share(const SubsystemDescriptor& subsystem, const Configuration* in_force) noexcept {
  double share = 0;
  if (in_force != nullptr && in_force->shortest().count() > 0)
    share = static_cast<double>(in_force->load().count()) / static_cast<double>(in_force->shortest().count());
  for (std::size_t i = 0; i < subsystem.service_loops.size(); ++i)
    if (const ServiceLoop& loop = subsystem.loop_in_force(i, in_force); loop.priority > 0 && loop.period.count() > 0)
      share += static_cast<double>(loop.budget.count()) / static_cast<double>(loop.period.count());
  return share;
}

std::vector<std::string_view> actuators_without_enable(const SubsystemDescriptor& subsystem) {
  std::vector<std::string_view> names;
  for (const Device& device : subsystem.devices)
    if (device.actuator && !device.enable) names.push_back(device.name);
  return names;
}

std::optional<ParameterRef> find_parameter(const SubsystemDescriptor& subsystem, std::uint32_t wire) {
  const auto is = [&](Type type, std::uint8_t id) { return ParameterId{subsystem.id, type, id}.wire() == wire; };
  for (std::size_t i = 0; i < subsystem.parameters.size(); ++i) {
    const Parameter& parameter = subsystem.parameters[i];
    const auto index = static_cast<std::uint16_t>(i);
    const std::string& name = parameter.field.name;
    if (is(parameter.field.type, parameter.id)) return ParameterRef{name, index, std::nullopt, {}};
    for (std::uint16_t m = 0; m < parameter.numbers(); ++m)
      if (const auto inner = parameter.identity_of(m); is(inner.type, inner.id))
        return ParameterRef{name + "." + std::string{inner.name}, index, m, {}};
  }
  return std::nullopt;
}

std::optional<ParameterRef> find_place(const SubsystemDescriptor& subsystem, std::string_view name) {
  const std::string_view owner = name.substr(0, name.find('.'));
  const Parameter* parameter = subsystem.find_parameter(owner);
  if (parameter == nullptr) return std::nullopt;
  const auto index = static_cast<std::uint16_t>(parameter - subsystem.parameters.data());
  if (owner.size() == name.size()) return ParameterRef{std::string{name}, index, std::nullopt, {}};
  for (std::uint16_t m = 0; m < parameter->numbers(); ++m)
    if (parameter->identity_of(m).name == name.substr(owner.size() + 1))
      return ParameterRef{std::string{name}, index, m, {}};
  return std::nullopt;
}

namespace {

/// Of the members of its parameter: first and one behind the last; a value without members is one.
[[nodiscard]] std::pair<std::size_t, std::size_t> extent(const SubsystemDescriptor& subsystem,
                                                         const ParameterRef& reference) {
  const Parameter& parameter = subsystem.parameters.at(reference.parameter);
  if (parameter.members.empty()) return {0, 1};
  const auto members = parameter.members_at(reference.member);
  const auto first = static_cast<std::size_t>(members.data() - parameter.members.data());
  return {first, first + members.size()};
}

}  // namespace

bool covers(const SubsystemDescriptor& subsystem, const ParameterRef& whole, const ParameterRef& part) {
  if (whole.parameter != part.parameter) return false;
  const auto [first, end] = extent(subsystem, whole);
  const auto [from, to] = extent(subsystem, part);
  return first <= from && to <= end;
}

bool overlap(const SubsystemDescriptor& subsystem, const ParameterRef& one, const ParameterRef& other) {
  if (one.parameter != other.parameter) return false;
  const auto [first, end] = extent(subsystem, one);
  const auto [from, to] = extent(subsystem, other);
  return first < to && from < end;
}

ParameterId identity_of(const SubsystemDescriptor& subsystem, const ParameterRef& reference) {
  const Parameter& parameter = subsystem.parameters.at(reference.parameter);
  if (!reference.member) return {subsystem.id, parameter.field.type, parameter.id};
  const auto inner = parameter.identity_of(*reference.member);
  return {subsystem.id, inner.type, inner.id};
}

std::vector<Field> fields_of(const SubsystemDescriptor& subsystem, const ParameterRef& reference) {
  const Parameter& parameter = subsystem.parameters.at(reference.parameter);
  if (parameter.field.type != Type::Struct) return {parameter.field};
  std::vector<Field> fields;
  for (const Parameter::Member& member : parameter.members_at(reference.member)) fields.push_back(member.field);
  return fields;
}

std::vector<Value> values_at_begin(const Parameter& parameter) {
  if (!parameter.init.empty()) return parameter.init;
  std::vector<Value> values;
  const auto add = [&](const Field& field) {
    const Value nothing = field.type == Type::Text ? Value{std::string{}} : Value{Number{0}};
    values.insert(values.end(), field.values(), nothing);
  };
  if (parameter.members.empty()) add(parameter.field);
  for (const Parameter::Member& member : parameter.members) add(member.field);
  return values;
}

void begin_with(Parameter& parameter, std::optional<std::uint16_t> member, std::vector<Value> values) {
  std::size_t first = 0;
  for (const Parameter::Member* each = parameter.members.data(); each != parameter.members_at(member).data(); ++each)
    first += each->field.values();
  parameter.init = values_at_begin(parameter);
  std::ranges::move(values, parameter.init.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace hirosco::descriptor
