// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "hirosco/descriptor/framework_events.hpp"
#include "hirosco/subsystem/generic_subsystem.hpp"

/// How an author introduces its parts in Software-Init, compared with the descriptor: every difference is collected, so
/// that one look tells all of them.
namespace hirosco {
namespace {

struct TypeRange {
  bool integer{true};
  double lowest{0.0};
  double highest{0.0};
  int digits{0};
};

[[nodiscard]] TypeRange range_of(Type type) {
  const auto of = []<class T>(T) {
    const ArgumentRange range = detail::range_of<T>();
    return TypeRange{range.integer, range.lowest, range.highest, range.digits};
  };
  switch (type) {
    case Type::Uint8: return of(std::uint8_t{});
    case Type::Int8: return of(std::int8_t{});
    case Type::Uint16: return of(std::uint16_t{});
    case Type::Int16: return of(std::int16_t{});
    case Type::Uint32: return of(std::uint32_t{});
    case Type::Int32: return of(std::int32_t{});
    case Type::Uint64: return of(std::uint64_t{});
    case Type::Int64: return of(std::int64_t{});
    case Type::Float: return of(float{});
    case Type::Double:
    case Type::Struct: break;
  }
  return of(double{});
}

/// Whether a C++ type takes every value that the descriptor permits, as it is.
[[nodiscard]] bool holds(const ArgumentRange& handler, const descriptor::Field& declared) {
  const TypeRange type = range_of(declared.type);
  if (!handler.integer) {
    // Calls carry doubles: whole numbers above 2^53 are refused before they come here.
    constexpr int digits_of_a_call = std::numeric_limits<double>::digits;
    return handler.digits >= std::min(type.digits, digits_of_a_call);
  }
  if (!type.integer) return false;
  const double lowest = std::max(type.lowest, declared.minimum.value_or(type.lowest));
  const double highest = std::min(type.highest, declared.maximum.value_or(type.highest));
  return handler.lowest <= lowest && highest <= handler.highest;
}

}  // namespace

void GenericSubsystem::mistake(std::string problem) {
  // A software_init() that needs several rounds may say the same again.
  if (std::ranges::find(problems_, problem) == problems_.end()) problems_.push_back(std::move(problem));
}

void GenericSubsystem::provide(CustomService& service) {
  if (std::ranges::find(own_services_, &service) != own_services_.end()) return;
  service.join(*this);
  own_services_.push_back(&service);
  services_.push_back(&service);
}

void GenericSubsystem::bind_function(std::string_view name, std::span<const ArgumentRange> arguments,
                                     FunctionHandler handler) {
  const auto& functions = descriptor_.functions;
  const auto found = std::ranges::find(functions, name, &descriptor::Function::name);
  const std::string who = "on_function " + std::string{name} + ": ";
  if (found == functions.end())
    return mistake("on_function: the descriptor declares no function '" + std::string{name} + "'");
  // An array is handed over element by element.
  std::vector<const descriptor::Field*> values;
  for (const auto& argument : found->arguments) values.insert(values.end(), argument.field.count, &argument.field);
  if (values.size() != arguments.size())
    return mistake(who + "the handler takes " + std::to_string(arguments.size()) +
                   " arguments, the descriptor declares " + std::to_string(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!holds(arguments[i], *values[i]))
      mistake(who + "the C++ type of argument " + std::to_string(i + 1) + " does not hold every value of " +
              values[i]->name + ", which is " + std::string{to_text(values[i]->type)});
  cycle_.functions()[static_cast<std::size_t>(found - functions.begin())].handler = std::move(handler);
}

void GenericSubsystem::publish(std::string_view name, ParameterCell& parameter) {
  if (const auto published = dictionary_.publish(name, parameter); !published) mistake(published.error());
}

void GenericSubsystem::use_event(EventPort& event) {
  const descriptor::Event* declared = descriptor_.find_event(event.name());
  if (declared == nullptr)
    return mistake("use_event: the descriptor declares no event '" + std::string{event.name()} + "'");
  const bool same = std::ranges::equal(event.arguments(), declared->arguments, [](const NativeField& n, const auto& d) {
    return n.type == d.type && n.count == d.count;
  });
  used_events_.push_back(declared->id);
  if (same) return event.bind(declared->id);
  std::string native, wanted;
  for (const auto& field : event.arguments()) native.append(native.empty() ? "" : ", ").append(cpp_text(field));
  for (const auto& field : declared->arguments)
    wanted.append(wanted.empty() ? "" : ", ").append(descriptor_text(field.type, field.count));
  mistake("use_event " + std::string{event.name()} + ": its arguments are (" + native + "), the descriptor declares (" +
          wanted + ")");
}

void GenericSubsystem::require_link(std::string_view set, LinkInputPort& port) {
  const auto sets = descriptor::required_sets(descriptor_);
  if (std::ranges::find(sets, set) == sets.end())
    mistake("require_link: no configuration requires a set '" + std::string{set} + "'");
  link_ports_[std::string{set}] = &port;
}

void GenericSubsystem::use_device(std::string_view name, DevicePortBase& port) {
  const auto& devices = descriptor_.devices;
  if (std::ranges::find(devices, name, &descriptor::Device::name) == devices.end())
    mistake("use_device: the descriptor declares no device '" + std::string{name} + "'");
  device_ports_[std::string{name}] = &port;
}

/// What is missing when the author has said all.
void GenericSubsystem::check_introduction() {
  if (!dictionary_problem_.empty()) mistake(dictionary_problem_);
  std::string missing;
  if (!dictionary_.all_published(missing)) mistake("parameters declared but not published: " + missing);
  for (std::size_t i = 0; i < descriptor_.functions.size(); ++i)
    if (!cycle_.functions()[i].handler)
      mistake("function declared but without a handler: " + descriptor_.functions[i].name);
  for (const auto& event : descriptor_.events)
    if (event.id < descriptor::framework_event::first && !uses_all_events_ &&
        std::ranges::find(used_events_, event.id) == used_events_.end())
      mistake("event declared but never used: " + event.name);
  for (const CustomService* service : own_services_)
    for (std::string& problem : service->problems()) mistake(std::move(problem));
  for (const auto& declared : descriptor_.services)
    if (std::ranges::count(own_services_, declared.name, &CustomService::name) != 1)
      mistake("service declared but not provided once: " + declared.name);
}

void GenericSubsystem::forget_introduction() {
  dictionary_.unpublish_all();
  for (CustomService* service : own_services_) service->release();
  used_events_.clear();
  link_ports_.clear();
  device_ports_.clear();
  cycle_.functions().assign(descriptor_.functions.size(), {});
}

}  // namespace hirosco
